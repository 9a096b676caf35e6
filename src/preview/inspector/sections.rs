//! What `plumb probe` tells of a pixel, sorted by what one asks it for: the text is the program's own, line by line.

/// An explanation in parts.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Sections<'t> {
    /// What one wants to know: the hit, the colour, the bytes, what decided them. Names and values.
    pub(super) first: Vec<(&'t str, &'t str)>,
    /// Objects that are hit, the nearest with a `*`.
    pub(super) hits: Vec<&'t str>,
    /// Objects that are missed, and why.
    pub(super) misses: Vec<&'t str>,
    /// How many those are; of many they are not listed.
    pub(super) missed: usize,
    /// Rays, what they meet and what they bring; samples.
    pub(super) rays: Vec<&'t str>,
    /// Where the ray runs, and the bounds.
    pub(super) rest: Vec<&'t str>,
    /// What is no line of an explanation: why there is none, or not all of it.
    pub(super) trouble: Vec<&'t str>,
}

/// Columns of a line's name.
const NAME: usize = 13;

impl<'t> Sections<'t> {
    /// Of such a text.
    pub(super) fn of(text: &'t str) -> Self {
        let mut sections = Self::default();
        // The list that indented lines belong to.
        let mut objects = false;
        for line in text.lines() {
            if line.starts_with(' ') {
                if objects {
                    sections.object(line);
                } else {
                    sections.rays.push(line);
                }
                continue;
            }
            let Some((name, value)) = line.split_at_checked(NAME) else {
                sections.trouble.push(line);
                continue;
            };
            objects = false;
            match name.trim_end() {
                name @ ("hit" | "colour" | "bytes" | "decided by") => {
                    sections.first.push((name, value));
                }
                "objects" => {
                    objects = true;
                    sections.missed = missed(value);
                }
                "rays" | "in all" | "samples" | "sample" | "brings" => sections.rays.push(line),
                "scene" | "pixel" | "world point" | "ray from" | "direction" | "ambient"
                | "path length" | "times 255" | "f64" | "GPU" | "GPU's f32" => {
                    sections.rest.push(line);
                }
                _ => sections.trouble.push(line),
            }
        }
        sections
    }

    /// A line of the list of objects: a mark, the name, the type, `hit` or `miss`.
    fn object(&mut self, line: &'t str) {
        let words = line.get(4..).unwrap_or_default();
        match words.split_whitespace().nth(2) {
            Some("hit") => self.hits.push(line),
            // That misses are not listed is told there too.
            _ => self.misses.push(line.trim_start()),
        }
    }
}

/// How many of `7, 3 hit` are missed.
fn missed(objects: &str) -> usize {
    let mut numbers = objects
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|number| number.parse::<usize>().ok());
    let (all, hit) = (numbers.next(), numbers.next());
    all.unwrap_or(0).saturating_sub(hit.unwrap_or(0))
}
