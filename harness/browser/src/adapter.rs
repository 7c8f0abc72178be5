//! The adapter that the browser uses.

/// The adapter that the browser uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Adapter {
    /// SwiftShader, which is part of Chromium: the same on every machine.
    #[default]
    SwiftShader,
    /// The browser's own choice: the machine's GPU if it has one.
    Own,
}

impl std::str::FromStr for Adapter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "swiftshader" => Ok(Adapter::SwiftShader),
            "own" => Ok(Adapter::Own),
            _ => Err("expected swiftshader, or own for the browser's own choice".to_owned()),
        }
    }
}
