//! Version of a file, read first: glTF 1.0 has other members, and only its version makes a clear
//! message.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;

use super::error::{GltfError, excerpt};

/// Members that every version has, and those that identify the first version if it is not stated.
#[derive(Deserialize)]
struct Head {
    asset: Option<Asset>,
    meshes: Option<Items>,
    buffers: Option<Items>,
}

#[derive(Deserialize)]
struct Asset {
    version: Option<Value>,
    #[serde(rename = "minVersion")]
    min_version: Option<Value>,
}

/// A list since glTF 2.0, previously an object keyed by name. Its contents are skipped, so that
/// they take no memory.
enum Items {
    Listed,
    Named,
}

impl<'de> Deserialize<'de> for Items {
    fn deserialize<D: Deserializer<'de>>(items: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Items;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list or an object")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Items, A::Error> {
                while list.next_element::<IgnoredAny>()?.is_some() {}
                Ok(Items::Listed)
            }

            fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Items, A::Error> {
                while members.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Items::Named)
            }

            fn visit_unit<E: Error>(self) -> Result<Items, E> {
                Ok(Items::Listed)
            }
        }
        items.deserialize_any(Either)
    }
}

/// Refuses unsupported versions. Malformed JSON is left to the full parser.
pub(super) fn check(json: &[u8]) -> Result<(), GltfError> {
    let Ok(head) = serde_json::from_slice::<Head>(json) else { return Ok(()) };
    let asset = head.asset.unwrap_or(Asset { version: None, min_version: None });
    // 1.0 files may also store it as a number, or omit it.
    let text = |version: Value| match version {
        Value::String(text) => text,
        other => other.to_string(),
    };
    let (version, least) = (asset.version.map(text), asset.min_version.map(text));
    let is_first = [head.meshes, head.buffers].iter().any(|items| matches!(items, Some(Items::Named)));
    let refused = match (version, least) {
        (Some(version), _) if !version.starts_with("2.") => Some(version),
        (_, Some(least)) if least != "2.0" => Some(least),
        (None, _) if is_first => Some("1.0".to_owned()),
        _ => None,
    };
    refused.map_or(Ok(()), |version| Err(GltfError::Version { version: excerpt(&version) }))
}
