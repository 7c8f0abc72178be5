//! What a page does while it is watched: its requests, and what goes wrong.

use serde_json::Value;
use std::collections::BTreeMap;

/// What has happened since the page was opened.
#[derive(Debug, Default)]
pub(super) struct Record {
    /// Whether the page has loaded.
    pub(super) loaded: bool,
    /// Whether its process is gone.
    pub(super) crashed: bool,
    /// Addresses, in the order in which they were asked for.
    pub(super) requests: Vec<String>,
    /// Errors, a line each.
    pub(super) problems: Vec<String>,
    /// Addresses by the protocol's numbers for requests.
    pending: BTreeMap<String, String>,
}

impl Record {
    /// Takes note of an event.
    pub(super) fn note(&mut self, method: &str, params: &Value) {
        match method {
            "Page.loadEventFired" => self.loaded = true,
            "Inspector.targetCrashed" => {
                self.crashed = true;
                self.problems.push("the page's process crashed".to_owned());
            }
            "Runtime.exceptionThrown" => {
                self.problems.push(format!("uncaught: {}", exception(&params["exceptionDetails"])))
            }
            "Runtime.consoleAPICalled" if params["type"] == "error" || params["type"] == "assert" => {
                let words: Vec<String> = params["args"].as_array().into_iter().flatten().map(shown).collect();
                self.problems.push(format!("console.error: {}", words.join(" ")));
            }
            // Failed requests are noted below.
            "Log.entryAdded" if params["entry"]["level"] == "error" && params["entry"]["source"] != "network" => {
                let entry = &params["entry"];
                self.problems.push(format!("logged: {} ({})", text(&entry["text"]), text(&entry["url"])));
            }
            "Network.requestWillBeSent" => {
                let address = text(&params["request"]["url"]).to_owned();
                self.pending.insert(text(&params["requestId"]).to_owned(), address.clone());
                self.requests.push(address);
            }
            "Network.loadingFailed" if params["canceled"] != true => {
                let address = self.pending.get(text(&params["requestId"])).map_or("?", String::as_str);
                self.problems.push(format!("request failed: {address}: {}", text(&params["errorText"])));
            }
            "Network.responseReceived" if params["response"]["status"].as_u64().is_some_and(|status| status >= 400) => {
                let response = &params["response"];
                self.problems.push(format!("request failed: {}: {}", text(&response["url"]), response["status"]));
            }
            _ => {}
        }
    }
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// Returns a remote object as the console shows it.
fn shown(object: &Value) -> String {
    match (&object["description"], &object["value"]) {
        (Value::String(text), _) | (_, Value::String(text)) => text.clone(),
        (_, value) => value.to_string(),
    }
}

/// Returns an exception's text, with the place where it was thrown if it has no stack.
pub(super) fn exception(details: &Value) -> String {
    let what = match &details["exception"] {
        Value::Null => String::new(),
        object => shown(object),
    };
    let line = details["lineNumber"].as_u64().map_or(0, |line| line + 1);
    match (what.is_empty(), details["url"].as_str()) {
        (false, _) => what,
        (true, Some(url)) => format!("{} ({url}:{line})", text(&details["text"])),
        (true, None) => text(&details["text"]).to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn failures_are_told_from_what_is_in_order() {
        let mut record = Record::default();
        let mut note = |method: &str, params: Value| record.note(method, &params);
        note("Network.requestWillBeSent", json!({ "requestId": "1", "request": { "url": "file:///a.png" } }));
        note(
            "Network.responseReceived",
            json!({ "requestId": "1", "response": { "url": "file:///a.png", "status": 200 } }),
        );
        note("Runtime.consoleAPICalled", json!({ "type": "log", "args": [{ "value": "all is well" }] }));
        note("Network.loadingFailed", json!({ "requestId": "1", "errorText": "net::ERR_ABORTED", "canceled": true }));
        note("Network.loadingFailed", json!({ "requestId": "1", "errorText": "net::ERR_FILE_NOT_FOUND" }));
        note("Runtime.consoleAPICalled", json!({ "type": "error", "args": [{ "value": "no" }, { "value": 3 }] }));
        note("Network.responseReceived", json!({ "response": { "url": "http://b/", "status": 404 } }));
        note("Page.loadEventFired", json!({}));
        assert!(record.loaded && !record.crashed);
        assert_eq!(record.requests, ["file:///a.png"]);
        let expected = [
            "request failed: file:///a.png: net::ERR_FILE_NOT_FOUND",
            "console.error: no 3",
            "request failed: http://b/: 404",
        ];
        assert_eq!(record.problems, expected);
    }
}
