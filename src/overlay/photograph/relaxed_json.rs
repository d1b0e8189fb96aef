//! A small bounded reader of JSON as people write it: `-.98`, `+3`, `5.`, a comma before a closing bracket, and comments are
//! let through, and everything else is held to RFC 8259.

/// Deepest nesting that is followed.
const DEEPEST: usize = 32;

/// A value. The members of an object keep their order.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number; always finite.
    Number(f64),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Value>),
    /// An object.
    Object(Vec<(String, Value)>),
}

impl Value {
    /// The member of an object, by its name in any case of letters.
    #[must_use]
    pub fn member(&self, name: &str) -> Option<&Value> {
        let Value::Object(members) = self else { return None };
        members.iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value)
    }

    /// The values of an array; none of anything else.
    #[must_use]
    pub fn list(&self) -> &[Value] {
        if let Value::List(values) = self { values } else { &[] }
    }

    /// A number.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        if let Value::Number(number) = self { Some(*number) } else { None }
    }

    /// A string.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text) } else { None }
    }
}

/// What stands where something else was expected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct JsonError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: &'static str,
}

/// Reads one value and nothing after it.
///
/// # Errors
/// The first line that cannot be understood, or nesting deeper than 32.
pub fn read(text: &str) -> Result<Value, JsonError> {
    let mut reader = Reader { bytes: text.as_bytes(), text, at: 0 };
    let value = reader.value(0)?;
    reader.space()?;
    if reader.at < reader.bytes.len() { Err(reader.wrong("there is something after the end")) } else { Ok(value) }
}

struct Reader<'a> {
    bytes: &'a [u8],
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    fn wrong(&self, what: &'static str) -> JsonError {
        let read = &self.bytes[..self.at.min(self.bytes.len())];
        JsonError { line: 1 + read.iter().filter(|byte| **byte == b'\n').count(), what }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn takes(&mut self, byte: u8) -> bool {
        let there = self.peek() == Some(byte);
        self.at += usize::from(there);
        there
    }

    /// Goes over white space and comments.
    fn space(&mut self) -> Result<(), JsonError> {
        loop {
            match self.peek() {
                Some(b' ' | b'\t' | b'\r' | b'\n') => self.at += 1,
                Some(b'/') => {
                    let rest = &self.bytes[self.at..];
                    let (closing, skipped): (&[u8], usize) = match rest.get(1) {
                        Some(b'/') => (b"\n", 1),
                        Some(b'*') => (b"*/", 2),
                        _ => return Err(self.wrong("a / stands alone")),
                    };
                    let end = rest.windows(closing.len()).skip(2).position(|window| window == closing);
                    // A comment of a line may end the text; one of its own brackets may not.
                    self.at += match end {
                        Some(end) => 2 + end + skipped,
                        None if skipped == 1 => rest.len(),
                        None => return Err(self.wrong("a comment has no end")),
                    };
                }
                _ => return Ok(()),
            }
        }
    }

    fn value(&mut self, depth: usize) -> Result<Value, JsonError> {
        if depth > DEEPEST {
            return Err(self.wrong("it is nested deeper than 32"));
        }
        self.space()?;
        match self.peek() {
            Some(b'{') => self.object(depth),
            Some(b'[') => self.list(depth),
            Some(b'"') => self.string().map(Value::Text),
            Some(b'-' | b'+' | b'.' | b'0'..=b'9') => self.number(),
            _ => {
                for (word, value) in [("null", Value::Null), ("true", Value::Bool(true)), ("false", Value::Bool(false))]
                {
                    if self.bytes[self.at..].starts_with(word.as_bytes()) {
                        self.at += word.len();
                        return Ok(value);
                    }
                }
                Err(self.wrong("a value is missing"))
            }
        }
    }

    fn object(&mut self, depth: usize) -> Result<Value, JsonError> {
        self.at += 1;
        let mut members = Vec::new();
        loop {
            self.space()?;
            if self.takes(b'}') {
                return Ok(Value::Object(members));
            }
            if self.peek() != Some(b'"') {
                return Err(self.wrong("a name in quotation marks is missing"));
            }
            let name = self.string()?;
            self.space()?;
            if !self.takes(b':') {
                return Err(self.wrong("a colon is missing"));
            }
            members.push((name, self.value(depth + 1)?));
            self.space()?;
            if !self.takes(b',') && self.peek() != Some(b'}') {
                return Err(self.wrong("a comma or a closing brace is missing"));
            }
        }
    }

    fn list(&mut self, depth: usize) -> Result<Value, JsonError> {
        self.at += 1;
        let mut values = Vec::new();
        loop {
            self.space()?;
            if self.takes(b']') {
                return Ok(Value::List(values));
            }
            values.push(self.value(depth + 1)?);
            self.space()?;
            if !self.takes(b',') && self.peek() != Some(b']') {
                return Err(self.wrong("a comma or a closing bracket is missing"));
            }
        }
    }

    fn number(&mut self) -> Result<Value, JsonError> {
        let start = self.at;
        while matches!(self.peek(), Some(b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9')) {
            self.at += 1;
        }
        // Rust reads `-.98`, `+3` and `5.` as numbers, and neither `1-2` nor `.`.
        match self.text[start..self.at].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Value::Number(number)),
            _ => Err(self.wrong("a number cannot be read")),
        }
    }

    fn string(&mut self) -> Result<String, JsonError> {
        self.at += 1;
        let mut string = String::new();
        loop {
            let start = self.at;
            while !matches!(self.peek(), None | Some(b'"' | b'\\')) {
                self.at += 1;
            }
            // Both ends are at an ASCII character, so between characters.
            string.push_str(&self.text[start..self.at]);
            if self.peek().is_none() {
                return Err(self.wrong("a closing quotation mark is missing"));
            }
            if self.takes(b'"') {
                return Ok(string);
            }
            self.at += 1;
            string.push(self.escaped()?);
        }
    }

    /// The character that an escape stands for, after its backslash.
    fn escaped(&mut self) -> Result<char, JsonError> {
        let byte = self.peek();
        self.at += 1;
        Ok(match byte {
            Some(b'n') => '\n',
            Some(b't') => '\t',
            Some(b'r') => '\r',
            Some(b'b') => '\u{8}',
            Some(b'f') => '\u{c}',
            Some(plain @ (b'"' | b'\\' | b'/')) => char::from(plain),
            Some(b'u') => {
                let first = self.hexadecimal()?;
                let low = if (0xD800..0xDC00).contains(&first) && self.bytes[self.at..].starts_with(b"\\u") {
                    self.at += 2;
                    Some(self.hexadecimal()?)
                } else {
                    None
                };
                let code = match low {
                    Some(low @ 0xDC00..0xE000) => 0x1_0000 + ((first - 0xD800) << 10) + (low - 0xDC00),
                    Some(_) => return Err(self.wrong("half of a character is missing")),
                    None => first,
                };
                char::from_u32(code).ok_or_else(|| self.wrong("half of a character is missing"))?
            }
            _ => return Err(self.wrong("an escape cannot be read")),
        })
    }

    fn hexadecimal(&mut self) -> Result<u32, JsonError> {
        let digits = self.bytes.get(self.at..self.at + 4).and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits
            .filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
            .and_then(|digits| u32::from_str_radix(digits, 16).ok());
        self.at += 4;
        code.ok_or_else(|| self.wrong("an escape cannot be read"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_as_people_write_them_are_read() {
        let value = read("// corners\n[-.9794, +3, 5., 1e3, /* last */ 0.5,]").unwrap();
        let numbers: Vec<f64> = value.list().iter().filter_map(Value::number).collect();
        assert_eq!(numbers, [-0.9794, 3.0, 5.0, 1000.0, 0.5]);
    }

    #[test]
    fn names_are_found_in_any_case_and_escapes_become_their_characters() {
        let value = read(r#"{"Short": "Andr\u00e9 \ud83d\ude00 \"x\"", "n": null, "t": true}"#).unwrap();
        assert_eq!(value.member("short").and_then(Value::text), Some("André 😀 \"x\""));
        assert_eq!(value.member("N"), Some(&Value::Null));
        assert_eq!(value.member("T"), Some(&Value::Bool(true)));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line) in [
            ("", 1),
            ("[1\n2]", 2),
            ("{\"a\" 1}", 1),
            ("{\n\n a: 1}", 3),
            ("\"open", 1),
            ("\"\\ud800\"", 1),
            ("\"\\u12\"", 1),
            ("[1-2]", 1),
            ("1e999", 1),
            (".", 1),
            ("[] []", 1),
            ("/* no end *", 1),
            ("/", 1),
        ] {
            assert_eq!(read(text).unwrap_err().line, line, "{text}");
        }
        assert_eq!(read(&"[".repeat(100_000)).unwrap_err().what, "it is nested deeper than 32");
    }

    proptest! {
        #[test]
        fn whatever_serde_json_writes_is_read_as_the_same(numbers in proptest::collection::vec(any::<f64>(), 0..8), text in ".*") {
            let numbers: Vec<f64> = numbers.into_iter().filter(|number| number.is_finite()).collect();
            let written = serde_json::json!({ "text": text, "numbers": numbers }).to_string();
            let value = read(&written).unwrap();
            prop_assert_eq!(value.member("text").and_then(Value::text), Some(text.as_str()));
            let back: Vec<f64> = value.member("numbers").unwrap().list().iter().filter_map(Value::number).collect();
            prop_assert_eq!(back, numbers);
        }

        #[test]
        fn no_text_makes_it_panic(text in r#"[\[\]{}",:\\/*u0-9a-f.+\-\n é]{0,80}"#) {
            let _ = read(&text);
        }
    }
}
