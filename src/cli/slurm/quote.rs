//! Words of a shell's command line: whatever a name holds, the shell takes it as it is.

use std::ffi::OsStr;

/// A word for the shell. What is plain stays as it is, for people to read.
pub(super) fn quoted(word: &OsStr) -> Vec<u8> {
    let bytes = word.as_encoded_bytes();
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"._-/=:,+@%".contains(byte);
    if !bytes.is_empty() && bytes.iter().all(plain) {
        return bytes.to_vec();
    }
    let mut quoted = vec![b'\''];
    for byte in bytes {
        match byte {
            // The quotes end, a quote stands for itself, they begin again.
            b'\'' => quoted.extend(br"'\''"),
            byte => quoted.push(*byte),
        }
    }
    quoted.push(b'\'');
    quoted
}

/// Words side by side.
pub(super) fn line<'a>(words: impl IntoIterator<Item = &'a OsStr>) -> Vec<u8> {
    words
        .into_iter()
        .map(quoted)
        .collect::<Vec<_>>()
        .join(&b' ')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_themselves_to_a_shell() {
        let plain = |word: &str| String::from_utf8(quoted(OsStr::new(word))).unwrap();
        assert_eq!(plain("--size=10x20"), "--size=10x20");
        assert_eq!(plain(""), "''");
        assert_eq!(plain("it's $HOME; `rm`\n*"), "'it'\\''s $HOME; `rm`\n*'");
        assert_eq!(plain("~/a"), "'~/a'");
    }
}
