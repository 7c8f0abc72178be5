//! Extensions that the gltf crate leaves as JSON, read with error messages that name the member.

use glam::Vec3;
use serde_json::{Map, Value};

/// Members of a JSON object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extension<'a> {
    /// `None` if the file does not have the extension.
    members: Option<&'a Map<String, Value>>,
}

impl<'a> Extension<'a> {
    /// Extension `name` from `all` extensions of a part of the file.
    pub(super) fn of(all: Option<&'a Map<String, Value>>, name: &str) -> Result<Self, String> {
        let value = all.and_then(|all| all.get(name));
        let members = value.map(|value| value.as_object().ok_or_else(|| wrong_kind(name, value, "an object")));
        Ok(Self { members: members.transpose()? })
    }

    /// Members of an object inside an extension; any other value has no members.
    pub(super) fn inside(value: &'a Value) -> Self {
        Self { members: value.as_object() }
    }

    /// Whether the file has the extension.
    pub(super) fn is_there(&self) -> bool {
        self.members.is_some()
    }

    pub(super) fn member(&self, key: &str) -> Option<&'a Value> {
        self.members.and_then(|members| members.get(key))
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, String> {
        let number = self.member(key).map(|value| value.as_f64().ok_or_else(|| wrong_kind(key, value, "a number")));
        number.transpose()
    }

    /// A number; `None` if the member is absent, or null: JSON has no infinity, for which JavaScript writes null.
    pub(super) fn number_or_null(&self, key: &str) -> Result<Option<f64>, String> {
        if self.member(key).is_some_and(Value::is_null) { Ok(None) } else { self.number(key) }
    }

    pub(super) fn four_numbers(&self, key: &str) -> Result<Option<[f64; 4]>, String> {
        self.numbers(key, "four numbers")
    }

    pub(super) fn three_numbers(&self, key: &str) -> Result<Option<[f64; 3]>, String> {
        self.numbers(key, "three numbers")
    }

    pub(super) fn two_numbers(&self, key: &str) -> Result<Option<[f64; 2]>, String> {
        self.numbers(key, "two numbers")
    }

    fn numbers<const N: usize>(&self, key: &str, expected: &str) -> Result<Option<[f64; N]>, String> {
        let Some(value) = self.member(key) else {
            return Ok(None);
        };
        let wrong = || wrong_kind(key, value, expected);
        let values: &[Value; N] =
            value.as_array().and_then(|list| list.as_slice().try_into().ok()).ok_or_else(wrong)?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(values) {
            *number = value.as_f64().ok_or_else(wrong)?;
        }
        Ok(Some(numbers))
    }

    /// A whole number of at least 0; `None` if the member is absent.
    pub(super) fn index(&self, key: &str) -> Result<Option<usize>, String> {
        let index = |value: &Value| value.as_u64().and_then(|index| usize::try_from(index).ok());
        let wrong = |value| wrong_kind(key, value, "a whole number of at least 0");
        self.member(key).map(|value| index(value).ok_or_else(|| wrong(value))).transpose()
    }

    /// A share, from 0 to 1; `None` if the member is absent.
    pub(super) fn share(&self, key: &str) -> Result<Option<f32>, String> {
        match self.number(key)? {
            Some(share) if !(0.0..=1.0).contains(&share) => {
                Err(format!("its {key} is {share:?}, but must lie from 0 to 1"))
            }
            share => Ok(share.map(|share| share as f32)),
        }
    }

    /// Linear RGB, each from 0 to 1; `None` if the member is absent.
    pub(super) fn color(&self, key: &str) -> Result<Option<Vec3>, String> {
        let Some(color) = self.three_numbers(key)? else {
            return Ok(None);
        };
        if !color.iter().all(|part| (0.0..=1.0).contains(part)) {
            return Err(format!("its {key} is {color:?}, but each part must lie from 0 to 1"));
        }
        Ok(Some(Vec3::from_array(color.map(|part| part as f32))))
    }

    /// Values of a list; empty if the member is absent.
    pub(super) fn list(&self, key: &str) -> Result<&'a [Value], String> {
        let list = self.member(key).map(|value| value.as_array().ok_or_else(|| wrong_kind(key, value, "an array")));
        Ok(list.transpose()?.map(Vec::as_slice).unwrap_or_default())
    }
}

fn wrong_kind(name: &str, value: &Value, expected: &str) -> String {
    let found = match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array of something else",
        Value::Object(_) => "an object",
    };
    format!("its {name} is {found}, but must be {expected}")
}
