//! An error and its causes in one line, nothing twice.

/// Some causes stand in the text above them already, and some paths are named by both.
pub fn said(error: &anyhow::Error) -> String {
    let mut parts: Vec<String> = vec![];
    for cause in error.chain() {
        let text = cause.to_string();
        if parts.last().is_some_and(|last| last.ends_with(&text)) {
            continue;
        }
        if parts
            .last()
            .is_some_and(|last| text.starts_with(&format!("{last}: ")))
        {
            parts.pop();
        }
        parts.push(text);
    }
    parts.join(": ")
}

#[cfg(test)]
mod tests {
    use super::said;

    #[test]
    fn what_was_said_is_not_said_again() {
        let error = |texts: [&'static str; 3]| {
            let [first, second, last] = texts;
            said(&anyhow::anyhow!(last).context(second).context(first))
        };
        assert_eq!(error(["d", "d: none", "none"]), "d: none");
        assert_eq!(error(["a", "b: none", "none"]), "a: b: none");
        assert_eq!(error(["a", "b", "c"]), "a: b: c");
    }
}
