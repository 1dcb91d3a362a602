//! Text from strangers, fit for terminals and logs. Format specification, section 10.

use core::fmt::Write;

/// The text with everything escaped that moves the cursor, turns the direction of writing or is not seen: control
/// characters, bidirectional controls, line and paragraph separators, characters without width, tags. As `\u{202e}`,
/// and backslashes stay as they are.
pub fn printable(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match is_hidden(c) {
            true => out.extend(c.escape_unicode()),
            false => out.push(c),
        }
    }
    out
}

/// The same for the text of JSON, where only what stands in strings can need it: as `\u202e`. Line feeds between the
/// values stay.
pub fn printable_json(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        if c == '\n' || !is_hidden(c) {
            out.push(c);
            continue;
        }
        for unit in c.encode_utf16(&mut [0; 2]) {
            // Writing to a string cannot fail.
            let _ = write!(out, "\\u{unit:04x}");
        }
    }
    out
}

fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hides_is_shown_and_what_is_seen_stays() {
        assert_eq!(
            printable("a\u{202e}b\u{1b}[2J\n"),
            "a\\u{202e}b\\u{1b}[2J\\u{a}"
        );
        let seen = "Himmel über Île-de-France, 空, سماء, 20 °C — \\";
        assert_eq!(printable(seen), seen);
        assert_eq!(printable_json(seen), seen);
        let hidden = [
            '\0',
            '\u{7f}',
            '\u{85}',
            '\u{9b}',
            '\u{200b}',
            '\u{200e}',
            '\u{2028}',
            '\u{2066}',
            '\u{feff}',
            '\u{e0041}',
        ];
        for c in hidden {
            assert!(printable(&c.to_string()).is_ascii(), "{c:?}");
            assert!(printable_json(&c.to_string()).is_ascii(), "{c:?}");
        }
    }

    #[test]
    fn json_means_the_same() {
        assert_eq!(
            printable_json("{\n  \"\u{202e}\": \"\u{e0041}\"\n}"),
            "{\n  \"\\u202e\": \"\\udb40\\udc41\"\n}"
        );
    }
}
