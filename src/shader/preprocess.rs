//! The directives of WGSL files, resolved: what makes one text the shaders of all scenes.
//!
//! A line `//#if name` … `//#else` … `//#end` keeps its lines where the name holds, and a line that ends in `//~` stays
//! only where pixels are certified. `//#insert what` is replaced by what is written for it.

/// What a file's directives are resolved with.
pub struct Directives<'a> {
    /// Whether the feature of this name holds; None if there is no such feature.
    pub holds: &'a dyn Fn(&str) -> Option<bool>,
    /// The text for `//#insert`; None if nothing is known by that.
    pub insert: &'a dyn Fn(&str) -> Option<String>,
    /// Whether bounds stay.
    pub certified: bool,
}

/// Appends the lines of `file` that stay to `text`.
///
/// # Errors
/// A directive that means nothing, an unknown name, an `//#if` without end. All directives are checked, those of parts
/// that are left out too: a misspelt name must not silently drop a bound.
pub fn preprocess(
    file: &str,
    directives: &Directives<'_>,
    text: &mut String,
) -> Result<(), String> {
    let mut included = vec![true];
    for (number, line) in (1..).zip(file.lines()) {
        let all = included.iter().all(|k| *k);
        let Some(directive) = line.trim_start().strip_prefix("//#") else {
            let bound = line.strip_suffix("//~");
            if all && (bound.is_none() || directives.certified) {
                text.push_str(bound.unwrap_or(line).trim_end());
                text.push('\n');
            }
            continue;
        };
        let wrong = |what: &str| format!("line {number}, `{}`: {what}", line.trim());
        match directive.split_once(' ').unwrap_or((directive, "")) {
            ("if", name) => {
                let holds = (directives.holds)(name);
                included.push(holds.ok_or_else(|| wrong("there is no such feature"))?);
            }
            ("else", "") if included.len() > 1 => {
                if let Some(last) = included.last_mut() {
                    *last = !*last;
                }
            }
            ("end", "") if included.len() > 1 => {
                included.pop();
            }
            ("insert", name) => {
                let inserted = (directives.insert)(name);
                let inserted = inserted.ok_or_else(|| wrong("nothing is known by that name"))?;
                if all {
                    preprocess(&inserted, directives, text)?;
                }
            }
            _ => return Err(wrong("this is no directive here")),
        }
    }
    if included.len() == 1 {
        Ok(())
    } else {
        Err("an `//#if` has no `//#end`".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(file: &str, certified: bool) -> Result<String, String> {
        let directives = Directives {
            holds: &|name| match name {
                "yes" => Some(true),
                "no" => Some(false),
                _ => None,
            },
            insert: &|name| (name == "two").then(|| "a\n//#if no\nb\n//#end\n".to_owned()),
            certified,
        };
        let mut text = String::new();
        preprocess(file, &directives, &mut text).map(|()| text)
    }

    #[test]
    fn what_holds_stays() {
        let file = "//#if yes\n1\n//#if no\n2\n//#else\n3 //~\n//#end\n//#end\n  //#insert two\n";
        assert_eq!(resolved(file, true).unwrap(), "1\n3\na\n");
        assert_eq!(resolved(file, false).unwrap(), "1\na\n");
    }

    #[test]
    fn a_typo_is_an_error_wherever_it_stands() {
        for file in [
            "//#if yse\n//#end\n",
            "//#if no\n//#if yse\n//#end\n//#end\n",
            "//#if no\n//#insert too\n//#end\n",
            "//#fi yes\n",
            "//#if yes\n",
            "//#end\n",
            "//#else\n",
            "//#if yes\n//#else yes\n//#end\n",
        ] {
            assert!(resolved(file, true).is_err(), "{file}");
        }
        let error = resolved("1\n  //#if yse\n//#end\n", true).unwrap_err();
        assert_eq!(error, "line 2, `//#if yse`: there is no such feature");
    }
}
