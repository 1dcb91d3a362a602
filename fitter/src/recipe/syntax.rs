//! What is wrong with the text of a recipe, in one line.

use super::error::{RecipeError, field};

/// With the line and column instead of a drawing.
pub fn error(text: &str, error: &toml::de::Error) -> RecipeError {
    let message: Vec<&str> = error.message().lines().map(str::trim).collect();
    let message = message.join(", ");
    RecipeError::Syntax(match error.span() {
        Some(span) => {
            let [line, column] = place(text, span.start);
            format!("line {line}, column {column}: {message}")
        }
        None => message,
    })
}

/// Line and column of a byte, from 1.
fn place(text: &str, byte: usize) -> [usize; 2] {
    let before = text.get(..byte).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |feed| feed + 1);
    let line = before.matches('\n').count() + 1;
    [line, before[start..].chars().count() + 1]
}

/// A ground that says nothing is one that was forgotten.
pub fn no_empty_ground(text: &str) -> Result<(), RecipeError> {
    let Ok(table) = toml::from_str::<toml::Table>(text) else {
        return Ok(());
    };
    let ground = table.get("ground").and_then(toml::Value::as_table);
    match ground.is_some_and(toml::Table::is_empty) {
        true => Err(field(
            "ground",
            "one of surface, albedo and table is needed",
        )),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::place;

    #[test]
    fn lines_and_columns_begin_at_one() {
        let text = "a = 1\nµ = 2\nb";
        assert_eq!(place(text, 0), [1, 1]);
        assert_eq!(place(text, 6), [2, 1]);
        assert_eq!(place(text, 9), [2, 3]);
        assert_eq!(place(text, 14), [3, 2]);
        assert_eq!(place("", 0), [1, 1]);
    }
}
