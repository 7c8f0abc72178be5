//! A function's source with its entry point, as text and as naga's IR.

use super::error::DispatchError;
use super::kernel::{self, kernel_source};
use super::layout::Layout;
use super::signature::Signature;
use super::source::parse;
use crate::tokens::{items, tokens};
use std::collections::BTreeSet;

/// Most words in a row of arguments or results.
const MOST_WORDS: usize = 16_384;

/// A function's source with its entry point, as text for any WGSL implementation. Each invocation
/// takes one row of arguments; bindings 0 (arguments) and 1 (results) are in group 0.
#[derive(Clone, Debug)]
pub struct KernelText {
    /// The source as given, followed by the kernel.
    pub text: String,
    /// Signature of the function.
    pub signature: Signature,
    /// Layout of a row of arguments.
    pub input: Layout,
    /// Layout of a row of results.
    pub output: Layout,
}

impl KernelText {
    /// Reflects `function` in `source` (`path` appears in messages) and writes its entry point.
    pub fn of_function(source: &str, path: &str, function: &str) -> Result<KernelText, DispatchError> {
        Self::reflect(source, path, function).map(|(kernel, _)| kernel)
    }

    fn reflect(source: &str, path: &str, function: &str) -> Result<(KernelText, naga::Module), DispatchError> {
        let (module, _) = parse(source, path)?;
        let signature = Signature::reflect(&module, function)?;
        let words: usize = signature.arguments.iter().map(|(_, shape)| shape.words()).sum();
        if words.max(signature.result.words()) > MOST_WORDS {
            let message = format!("`{function}` takes or returns over {MOST_WORDS} numbers; make its arrays smaller");
            return Err(DispatchError::Fault { line: None, message });
        }
        let kernel = kernel_source(&signature);
        refuse_clashes(source, &kernel, &signature)?;
        let text = format!("{source}\n{kernel}");
        let (module, _) = parse(&text, path)?;
        let input = Layout::of_struct(&module, kernel::INPUT);
        let output = Layout::of_struct(&module, kernel::OUTPUT);
        Ok((KernelText { text, signature, input, output }, module))
    }
}

/// A function's source with its entry point, as naga IR: the form that is compiled and mutated.
#[derive(Clone, Debug)]
pub struct KernelModule {
    /// Signature of the function.
    pub signature: Signature,
    /// Functions of the source, and the entry point.
    pub module: naga::Module,
    /// Layout of a row of arguments.
    pub input: Layout,
    /// Layout of a row of results.
    pub output: Layout,
}

impl KernelModule {
    /// Reflects `function` in `source` (`path` appears in messages) and appends its entry point.
    pub fn reflect(source: &str, path: &str, function: &str) -> Result<KernelModule, DispatchError> {
        let (KernelText { signature, input, output, .. }, module) = KernelText::reflect(source, path, function)?;
        Ok(KernelModule { signature, module, input, output })
    }
}

/// Refuses a source that declares a name that the kernel's text needs for another purpose, such as
/// the name of a built-in.
fn refuse_clashes(source: &str, kernel: &str, signature: &Signature) -> Result<(), DispatchError> {
    let mut needed: BTreeSet<&str> = tokens(kernel).iter().map(|token| token.text).collect();
    for name in kernel::HARMLESS {
        needed.remove(name);
    }
    needed.remove(signature.function.as_str());
    let meant = signature.structs();
    let code = tokens(source);
    let clash = items(&code).into_iter().find(|item| needed.contains(item.name) && !meant.contains(item.name));
    match clash {
        None => Ok(()),
        Some(item) => Err(DispatchError::Fault {
            line: Some(item.line),
            message: format!(
                "declares `{}`, a name that WGSL or the check's kernel needs for something else; rename it",
                item.name
            ),
        }),
    }
}
