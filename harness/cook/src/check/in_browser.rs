//! A function run by a browser: the same kernel, as text, with a different compiler and driver.

use lapidary_assay::dispatch::{DispatchError, ENTRY_POINT, KernelText, ROWS_PER_DISPATCH, WORKGROUP_SIZE};
use lapidary_assay::runner::Runner;
use lapidary_browser::{Browser, BrowserError, Buffer, Compute};

/// A kernel in a browser. Loop iterations are not counted: an endless loop ends when the browser
/// gives up.
#[derive(Debug)]
pub struct InBrowser<'browser> {
    browser: &'browser Browser,
    kernel: KernelText,
}

impl<'browser> InBrowser<'browser> {
    /// Returns the kernel in that browser, which compiles it on its first run.
    pub fn new(browser: &'browser Browser, kernel: KernelText) -> Self {
        Self { browser, kernel }
    }

    fn batch(&self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        let KernelText { text, input, output, .. } = &self.kernel;
        let rows = arguments.len() / self.argument_words();
        let mut bytes = vec![0; rows * input.stride];
        input.scatter(arguments, &mut bytes);
        let buffers = [
            Buffer { size: bytes.len(), filled: Some(&bytes), read: false },
            Buffer { size: rows * output.stride, filled: None, read: true },
        ];
        let workgroups = [rows.div_ceil(WORKGROUP_SIZE as usize) as u32, 1, 1];
        let found = self.browser.compute(&Compute { code: text, entry: ENTRY_POINT, buffers: &buffers, workgroups });
        let found = found.map_err(|error| {
            let what = match &error {
                BrowserError::Connection(_) => "the browser cannot be asked",
                BrowserError::Refused(_) => "the browser refused",
            };
            DispatchError::Runner(format!("{what}: {error}"))
        })?;
        output.gather(&found.concat(), rows, results);
        Ok(())
    }
}

impl Runner for InBrowser<'_> {
    fn argument_words(&self) -> usize {
        self.kernel.input.offsets.len()
    }

    fn result_words(&self) -> usize {
        self.kernel.output.offsets.len()
    }

    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        results.clear();
        let mut part = Vec::new();
        for rows in arguments.chunks(ROWS_PER_DISPATCH * self.argument_words()) {
            self.batch(rows, &mut part)?;
            results.extend_from_slice(&part);
        }
        Ok(())
    }

    fn is_portable(&self) -> bool {
        true
    }

    fn loops(&self) -> bool {
        // Makes the first dispatch a short one.
        true
    }

    fn stopped(&self, _row: usize) -> bool {
        false
    }

    fn any_stopped(&self) -> bool {
        false
    }

    fn why_stopped(&self) -> String {
        String::new()
    }
}
