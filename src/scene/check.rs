//! Checks of whole entities: that nothing is missing, and that attributes agree; for the parser with places in the
//! text, for the builder without. The last checks before an entity joins the [`Scene`](super::Scene).

use std::ops::Range;

use super::draft::Draft;
use super::kind::EntityKind;
use super::lex::{self, TokenKind};
use super::parser::{Block, Parser};
use super::table::{self, Attribute, Entity, Take};
use crate::diagnostic::Diagnostic;

impl Parser<'_> {
    pub(super) fn report_open_block(&mut self, entity: &Entity, title: &Range<usize>) {
        let token = self.window[0];
        let (span, message, label) = if token.kind == TokenKind::End {
            let message = format!("the file ends inside the block of this `{}`", entity.name);
            (self.last_end..self.last_end, message, "expected `}`")
        } else {
            let message = format!(
                "missing `}}` at the end of the block of this `{}`",
                entity.name
            );
            (token.span(), message, "expected `}` before it")
        };
        let error = Diagnostic::new(span, message).label(label);
        self.errors.report(
            error
                .also(title.clone(), "its block starts here")
                .help("add `}`"),
        );
    }

    pub(super) fn check_complete(&mut self, block: &Block, title: &Range<usize>) {
        let kind = block.entity.name;
        if block.entity.kind == EntityKind::Material {
            if block.given.iter().all(Option::is_none) && block.stranger.is_none() {
                let all: Vec<_> = block
                    .entity
                    .rows()
                    .map(|row| format!("`{}`", row.name))
                    .collect();
                let error =
                    Diagnostic::new(title.clone(), format!("this `{kind}` has no attributes"));
                self.errors
                    .report(error.help(format!("give at least one of {}", all.join(", "))));
            }
            return;
        }
        let rows = block.entity.rows().zip(&block.given);
        let missing: Vec<_> = rows
            .filter(|(row, given)| row.required && given.is_none())
            .map(|(row, _)| row)
            .collect();
        if missing.is_empty() {
            return;
        }
        let list = |text: fn(&Attribute) -> String| {
            let texts: Vec<_> = missing.iter().map(|row| text(row)).collect();
            texts.join(", ")
        };
        let examples = list(|row| format!("`{} {}`", row.name, row.example));
        let missing = list(|row| format!("`{}`", row.name));
        match block.stranger {
            // The unknown attribute is most likely the missing one misspelt, so both are told in one message.
            Some(stranger) => {
                if let Some(error) = self.errors.at(stranger) {
                    error
                        .secondary
                        .push((title.clone(), format!("this `{kind}` lacks {missing}")));
                }
            }
            None => {
                let error =
                    Diagnostic::new(title.clone(), format!("this `{kind}` lacks {missing}"));
                self.errors
                    .report(error.help(format!("add {examples}, for example")));
            }
        }
    }

    pub(super) fn check_relation(&mut self, block: &Block) {
        let place = |name: &str| {
            let (index, _) = block.entity.row(name.as_bytes())?;
            block.given[index].clone().filter(|_| block.good[index])
        };
        // One mistake is reported once, so what is asked of attributes that contradict others is not asked.
        for relation in block.entity.relations {
            let Some(span) = place(relation.attribute) else {
                continue;
            };
            let others = relation.others.iter().map(|other| place(other));
            let Some(others) = others.collect::<Option<Vec<_>>>() else {
                continue;
            };
            if (relation.broken)(&block.draft) {
                let mut error = Diagnostic::new(
                    span,
                    format!("`{}` {}", relation.attribute, relation.message),
                );
                for (name, other) in relation.others.iter().zip(others) {
                    error = error.also(other, format!("`{name}` is given here"));
                }
                self.errors.report(error);
                return;
            }
        }
    }

    pub(super) fn check_first_camera(&mut self, title: &Range<usize>) {
        match &self.camera {
            Some(first) => {
                let error = Diagnostic::new(title.clone(), "a second camera")
                    .label("a scene has exactly one");
                self.errors.report(
                    error
                        .also(first.clone(), "the first camera is here")
                        .help("remove one of them"),
                );
            }
            None => self.camera = Some(title.clone()),
        }
    }
}

/// What is wrong with an entity that was built in code, by the rows of its type. `materials` and `textures` are how
/// many there are to refer to.
pub(super) fn faults(
    kind: EntityKind,
    draft: &mut Draft,
    materials: usize,
    textures: usize,
) -> Vec<String> {
    let entity = table::of(kind);
    let mut faults = Vec::new();
    if !is_name(&draft.name) {
        faults.push(String::from(
            "a name is not empty, and holds no white space, braces or `#`",
        ));
    }
    for row in entity.rows() {
        let (count, kind) = match row.take {
            Take::Numbers(_, field) | Take::Integers(_, field) | Take::OneOrThree(field) => {
                if row.is_left_out(draft) {
                    continue;
                }
                faults.extend(row_fault(row, field(draft)));
                continue;
            }
            Take::Material(index) => (*index(draft) < materials, "material"),
            Take::Texture(index) => (*index(draft) < textures, "texture"),
            Take::Picture => continue,
        };
        if !count {
            faults.push(format!("`{}` is a {kind} of another builder", row.name));
        }
    }
    if faults.is_empty() {
        faults.extend(broken_relation(entity, draft));
    }
    faults
}

/// What is wrong with the numbers of one row.
fn row_fault(row: &Attribute, values: &[f64]) -> Option<String> {
    let name = row.name;
    if values.iter().any(|value| !value.is_finite()) {
        Some(format!("`{name}` must be finite"))
    } else if !row.limit.broken(values).is_empty() {
        let wording = row.limit.wording();
        Some(format!("`{name}` must be {wording}, and is {values:?}"))
    } else {
        None
    }
}

/// What is wrong with new numbers for an attribute, by its row: nothing of what attributes must keep between them.
pub(super) fn number_fault(row: &Attribute, values: &[f64]) -> Option<String> {
    let name = row.name;
    match row.take {
        Take::Numbers(count, _) | Take::Integers(count, _) if count != values.len() => Some(
            format!("`{name}` takes {count} of them, not {}", values.len()),
        ),
        Take::OneOrThree(_) if values.len() != 3 => {
            Some(format!("`{name}` takes 3 of them, not {}", values.len()))
        }
        Take::Integers(..) if values.iter().any(|value| value.fract() != 0.0) => {
            Some(format!("`{name}` takes whole numbers, and is {values:?}"))
        }
        _ => row_fault(row, values),
    }
}

/// What attributes of an entity fail to keep between them.
pub(super) fn broken_relation(entity: &Entity, draft: &Draft) -> Option<String> {
    let broken = entity.relations.iter().find(|r| (r.broken)(draft));
    broken.map(|r| format!("`{}` {}", r.attribute, r.message))
}

/// As in a scene from a file, zero is never negative.
pub(super) fn positive_zeros(kind: EntityKind, mut draft: Draft) -> Draft {
    for row in table::of(kind).rows() {
        if row.is_left_out(&mut draft) {
            continue;
        }
        if let Take::Numbers(_, field) | Take::OneOrThree(field) = row.take {
            field(&mut draft).iter_mut().for_each(|value| *value += 0.0);
        }
    }
    draft
}

pub(super) fn is_name(name: &str) -> bool {
    let mut lexer = lex::Lexer::new(name.as_bytes());
    let token = lexer.token();
    token.is_word() && token.text == name.as_bytes() && !name.contains('\0')
}
