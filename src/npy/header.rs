//! The header of an NPY file: a Python dictionary that says of what type the numbers are, in what order and what shape.
//!
//! Source: NumPy's format specification, "numpy.lib.format": the keys are 'descr', 'fortran_order' and 'shape', in any
//! order.

/// What the dictionary says.
#[derive(Debug, PartialEq)]
pub(super) struct Header {
    /// Byte order, kind and bytes of a number, such as `<f4`.
    pub(super) descr: String,
    /// The first index runs fastest.
    pub(super) fortran_order: bool,
    /// How many there are along each axis.
    pub(super) shape: Vec<usize>,
}

impl Header {
    pub(super) fn parse(text: &[u8]) -> Result<Self, String> {
        let mut scanner = Scanner { rest: text, length: text.len() };
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        scanner.expect(b'{', "`{`")?;
        while !scanner.accept(b'}') {
            let key = scanner.string()?;
            scanner.expect(b':', "`:`")?;
            match key.as_str() {
                "descr" => descr = Some(scanner.descr()?),
                "fortran_order" => fortran_order = Some(scanner.boolean()?),
                "shape" => shape = Some(scanner.shape()?),
                other => {
                    return Err(format!("the NPY header has an unknown key '{}'", other.escape_debug()));
                }
            }
            if !scanner.accept(b',') {
                scanner.expect(b'}', "`,` or `}`")?;
                break;
            }
        }
        scanner.end()?;
        let lacks = |key: &str| format!("the NPY header lacks '{key}'");
        Ok(Self {
            descr: descr.ok_or_else(|| lacks("descr"))?,
            fortran_order: fortran_order.ok_or_else(|| lacks("fortran_order"))?,
            shape: shape.ok_or_else(|| lacks("shape"))?,
        })
    }
}

/// Takes the few kinds of Python literals that a header may hold off the front of a text.
struct Scanner<'a> {
    rest: &'a [u8],
    /// Of the whole text, bytes.
    length: usize,
}

impl<'a> Scanner<'a> {
    fn descr(&mut self) -> Result<String, String> {
        if self.accept(b'[') {
            return Err("each element of the array is a record of several fields; save plain numbers".into());
        }
        self.string()
    }

    fn boolean(&mut self) -> Result<bool, String> {
        match self.take_while(u8::is_ascii_alphabetic) {
            b"True" => Ok(true),
            b"False" => Ok(false),
            _ => Err(self.damaged("True or False before here")),
        }
    }

    /// `()`, `(2,)` or `(2, 3)`.
    fn shape(&mut self) -> Result<Vec<usize>, String> {
        let mut shape = Vec::new();
        self.expect(b'(', "`(`")?;
        while !self.accept(b')') {
            let digits = self.take_while(u8::is_ascii_digit);
            if digits.is_empty() {
                return Err(self.damaged("a whole number"));
            }
            let size = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
            shape.push(size.ok_or("the shape in the NPY header is larger than any memory")?);
            if !self.accept(b',') {
                self.expect(b')', "`,` or `)`")?;
                break;
            }
        }
        Ok(shape)
    }

    /// Without escapes, which no header of ours needs.
    fn string(&mut self) -> Result<String, String> {
        let quote = if self.accept(b'"') {
            b'"'
        } else {
            self.expect(b'\'', "a string")?;
            b'\''
        };
        let length = self.rest.iter().position(|&byte| byte == quote);
        let content = &self.rest[..length.ok_or_else(|| self.damaged("a string with an end"))?];
        self.rest = &self.rest[content.len() + 1..];
        Ok(String::from_utf8_lossy(content).into_owned())
    }

    fn expect(&mut self, byte: u8, name: &str) -> Result<(), String> {
        if self.accept(byte) { Ok(()) } else { Err(self.damaged(name)) }
    }

    fn accept(&mut self, byte: u8) -> bool {
        self.skip_space();
        let rest = self.rest.strip_prefix(&[byte]);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn end(&mut self) -> Result<(), String> {
        self.skip_space();
        if self.rest.is_empty() { Ok(()) } else { Err(self.damaged("nothing but spaces")) }
    }

    fn take_while(&mut self, belongs: impl Fn(&u8) -> bool) -> &'a [u8] {
        self.skip_space();
        let length = self.rest.iter().position(|byte| !belongs(byte)).unwrap_or(self.rest.len());
        let (taken, rest) = self.rest.split_at(length);
        self.rest = rest;
        taken
    }

    fn skip_space(&mut self) {
        self.rest = self.rest.trim_ascii_start();
    }

    fn damaged(&self, expected: &str) -> String {
        let offset = self.length - self.rest.len();
        format!("the NPY header cannot be read: expected {expected} at its byte {offset}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_come_in_any_order_with_any_spaces_and_quotes() {
        let expected = Header { descr: "<f4".into(), fortran_order: false, shape: vec![2, 3] };
        for text in [
            "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }      \n",
            "{'shape':(2,3),'fortran_order':False,'descr':'<f4'}",
            " {\n\"fortran_order\" : False , \"shape\" : ( 2 , 3 , ) , \"descr\" : \"<f4\" , } ",
        ] {
            assert_eq!(Header::parse(text.as_bytes()).as_ref(), Ok(&expected), "{text}");
        }
    }

    #[test]
    fn a_shape_has_any_number_of_axes() {
        for (shape, expected) in
            [("()", &[][..]), ("(7,)", &[7]), ("(0, 8)", &[0, 8]), ("(1, 2, 3)", &[1, 2, 3])]
        {
            let text = format!("{{'descr': '<u4', 'fortran_order': True, 'shape': {shape}, }}");
            assert_eq!(Header::parse(text.as_bytes()).unwrap().shape, expected, "{shape}");
        }
    }

    #[test]
    fn what_is_no_header_is_refused_with_what_is_missing() {
        for (text, expected) in [
            ("", "expected `{` at its byte 0"),
            ("{'descr'", "expected `:` at its byte 8"),
            ("{'descr: 1", "expected a string with an end at its byte 2"),
            ("{'descr': 4", "expected a string at its byte 10"),
            ("{'descr': [('x', '<f4')]", "a record of several fields"),
            ("{'size': 4", "unknown key 'size'"),
            ("{'fortran_order': 1", "expected True or False before here at its byte 18"),
            ("{'shape': 3", "expected `(` at its byte 10"),
            ("{'shape': (-3", "expected a whole number at its byte 11"),
            ("{'shape': (3 4", "expected `,` or `)` at its byte 13"),
            ("{'shape': (99999999999999999999,", "larger than any memory"),
            ("{'shape': (3,) 'descr'", "expected `,` or `}` at its byte 15"),
            ("{'shape': (3,)} x", "expected nothing but spaces at its byte 16"),
            ("{}", "lacks 'descr'"),
            ("{'descr': '<f4', 'shape': (3,)}", "lacks 'fortran_order'"),
            ("{'descr': '<f4', 'fortran_order': False}", "lacks 'shape'"),
        ] {
            let message = Header::parse(text.as_bytes()).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
