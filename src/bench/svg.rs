//! The little of SVG that a plot takes: text that is escaped, shapes, a document.

use std::fmt::Write as _;

/// A drawing under way; lengths in pixels from the top left.
#[derive(Debug, Default)]
pub struct Svg {
    body: String,
}

/// Where a text stands to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The point is where it begins.
    Start,
    /// In the middle.
    Middle,
    /// Where it ends.
    End,
}

impl Svg {
    /// A line through the points, with attributes such as `stroke-dasharray='4 3'`.
    pub fn line(&mut self, points: &[(f64, f64)], attributes: &str) {
        let points: Vec<String> = points
            .iter()
            .map(|(x, y)| format!("{x:.1},{y:.1}"))
            .collect();
        let points = points.join(" ");
        let _ = writeln!(
            self.body,
            "<polyline points='{points}' fill='none' {attributes}/>"
        );
    }

    /// A rectangle.
    pub fn rectangle(&mut self, [x, y, width, height]: [f64; 4], attributes: &str) {
        let _ = writeln!(
            self.body,
            "<rect x='{x:.1}' y='{y:.1}' width='{width:.1}' height='{height:.1}' {attributes}/>"
        );
    }

    /// A path, in SVG's own notation.
    pub fn path(&mut self, path: &str, attributes: &str) {
        let _ = writeln!(self.body, "<path d='{path}' {attributes}/>");
    }

    /// A text, of any characters.
    pub fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, attributes: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            "<text x='{x:.1}' y='{y:.1}' text-anchor='{anchor}' {attributes}>{}</text>",
            escape(text)
        );
    }

    /// The document.
    #[must_use]
    pub fn finish(self, width: f64, height: f64, title: &str) -> String {
        format!(
            "<?xml version='1.0' encoding='UTF-8'?>\n\
             <svg xmlns='http://www.w3.org/2000/svg' width='{width:.0}' height='{height:.0}' \
             viewBox='0 0 {width:.0} {height:.0}' \
         font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='11'>\n\
             <title>{}</title>\n\
             <defs><pattern id='hatch' width='6' height='6' patternUnits='userSpaceOnUse'>\
             <path d='M0,6 L6,0' stroke='#bbb' stroke-width='0.8'/></pattern></defs>\n\
             <rect width='100%' height='100%' fill='white'/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// Text for between tags: what XML cannot hold is left out.
fn escape(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_control())
        .map(|c| match c {
            '&' => "&amp;".to_owned(),
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            c => c.to_string(),
        })
        .collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Whether tags are closed in order, attributes quoted, and nothing stands there that has to be escaped.
    pub(crate) fn well_formed(text: &str) -> Result<usize, String> {
        let mut open: Vec<&str> = Vec::new();
        let mut elements = 0;
        let mut rest = text;
        while let Some(start) = rest.find('<') {
            let between = &rest[..start];
            if between.contains('>')
                || between
                    .replace("&amp;", "")
                    .replace("&lt;", "")
                    .replace("&gt;", "")
                    .contains('&')
            {
                return Err(format!("not escaped: {between}"));
            }
            let end = rest[start..].find('>').ok_or("a tag has no end")? + start;
            let tag = &rest[start + 1..end];
            rest = &rest[end + 1..];
            if !tag.matches('\'').count().is_multiple_of(2) || tag.contains('<') {
                return Err(format!("quotes: {tag}"));
            }
            let name = tag
                .trim_start_matches('/')
                .split([' ', '/'])
                .next()
                .unwrap_or("");
            match tag {
                _ if tag.starts_with('?') => {}
                _ if tag.starts_with('/') => {
                    if open.pop() != Some(name) {
                        return Err(format!("</{name}> closes nothing"));
                    }
                }
                _ => {
                    elements += 1;
                    if !tag.ends_with('/') {
                        open.push(name);
                    }
                }
            }
        }
        if open.is_empty() {
            Ok(elements)
        } else {
            Err(format!("open: {open:?}"))
        }
    }

    #[test]
    fn any_text_can_be_drawn() {
        let mut svg = Svg::default();
        svg.text((1.0, 2.0), Anchor::End, "", "a<b>&\u{1}c");
        svg.line(&[(0.0, 0.0), (1.0, 1.0)], "stroke='black'");
        let text = svg.finish(10.0, 10.0, "<&>");
        assert_eq!(well_formed(&text), Ok(8));
        assert!(text.contains(">a&lt;b&gt;&amp;c</text>"));
        assert!(well_formed("<a><b></a>").is_err() && well_formed("<a>&</a>").is_err());
    }
}
