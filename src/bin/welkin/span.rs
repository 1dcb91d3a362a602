//! A value, or a course from one value to another.

use std::str::FromStr;

/// From `A`, or from `A..B`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<T> {
    pub first: T,
    pub last: T,
    /// Whether two values were given.
    pub is_course: bool,
}

impl<T: Copy> Span<T> {
    /// From text; `value` parses either end.
    pub fn parse<E>(text: &str, value: impl Fn(&str) -> Result<T, E>) -> Result<Self, E> {
        let ends = text.split_once("..");
        let (first, last) = ends.unwrap_or((text, text));
        Ok(Self {
            first: value(first)?,
            last: value(last)?,
            is_course: ends.is_some(),
        })
    }
}

impl Span<f64> {
    /// At a share of 0 to 1 of the way; the ends exactly.
    pub fn at(&self, share: f64) -> f64 {
        match self.is_course {
            true => (1.0 - share) * self.first + share * self.last,
            false => self.first,
        }
    }
}

impl FromStr for Span<f64> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::parse(text, |part| {
            let number = part.trim().parse();
            number.map_err(|_| format!("\"{part}\" is no number"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact_and_one_value_is_a_span() {
        let span: Span<f64> = "-4.2..60".parse().unwrap();
        assert_eq!(
            [span.at(0.0), span.at(0.5), span.at(1.0)],
            [-4.2, 27.9, 60.0]
        );
        let one: Span<f64> = "-4.2".parse().unwrap();
        assert_eq!([one.at(0.0), one.at(0.3), one.at(1.0)], [-4.2; 3]);
        assert!("1..x".parse::<Span<f64>>().is_err() && "..".parse::<Span<f64>>().is_err());
    }
}
