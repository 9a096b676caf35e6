//! What stands somewhere, as Rust: what pointers lead to, elements of lists, members of structs, components of vectors.
//! Of a record that all lanes share a member is a reference, else each lane reads its own (`certify/lanes/gather.rs`).

use naga::proc::TypeResolution;
use naga::{Expression, Handle, Type, TypeInner};

use super::expression::{ATOM, CAST, PARTS, Text, UNARY, atom, of_parts};
use super::kinds::Kind;
use super::signature::shared;
use super::statement::Writer;

impl Writer<'_> {
    /// What a pointer leads to, as a value.
    pub(super) fn load(&self, pointer: Handle<Expression>) -> Text {
        let text = self.expression(pointer);
        if self.kinds.get(pointer) == Kind::Place
            && matches!(
                self.function.expressions[pointer],
                Expression::FunctionArgument(_)
            )
        {
            return Text {
                rust: format!("*{}", text.rust),
                binding: UNARY,
            };
        }
        if self.kinds.get(pointer) == Kind::Gathered
            && self.inner(pointer).pointer_space().is_some()
            && matches!(
                self.function.expressions[pointer],
                Expression::Access { .. }
            )
            && let Some(ty) = self.type_handle(pointer)
            && matches!(self.shader.module.types[ty].inner, TypeInner::Scalar(_))
        {
            // An element of a list of numbers.
            return atom(format!("{}.u32(0)", text.rust));
        }
        text
    }

    pub(super) fn access(
        &self,
        expression: Handle<Expression>,
        base: Handle<Expression>,
        index: Handle<Expression>,
    ) -> Text {
        let text = self.expression(base).within(ATOM);
        match (self.kinds.get(base), self.kinds.is_shared(index)) {
            (Kind::Record, true) => {
                let index = self.expression(index).within(CAST);
                atom(format!("{text}[{index} as usize]"))
            }
            (Kind::Record, false) => {
                let index = self.expression(index).rust;
                let buffer = text.strip_prefix("scene.").unwrap_or(&text);
                atom(format!("scene.gather(&scene.{buffer}, {index})"))
            }
            (Kind::Place, _) => {
                let index = self.lanes(index).rust;
                atom(format!("scene.take(&{text}, {index})"))
            }
            _ => self.fail("an element by a number", expression),
        }
    }

    pub(super) fn member(
        &self,
        expression: Handle<Expression>,
        base: Handle<Expression>,
        index: u32,
    ) -> Text {
        let inner = match self.inner(base) {
            TypeInner::Pointer { base, .. } => &self.shader.module.types[*base].inner,
            inner => inner,
        };
        let text = self.expression(base).within(ATOM);
        let TypeInner::Struct { members, .. } = inner else {
            return match self.kinds.get(base) {
                Kind::Array => atom(format!("{text}[{index}]")),
                _ => match one_of_gathered(&text, index) {
                    Some(one) => atom(one),
                    None => atom(format!("{text}.{}", PARTS[index as usize])),
                },
            };
        };
        let field = members[index as usize].name.as_deref().unwrap_or_default();
        if self.kinds.get(base) != Kind::Gathered {
            return atom(format!("{text}.{field}"));
        }
        let member = members[index as usize].ty;
        // What stands in one buffer on a GPU, as some drivers allow few, are two lists here.
        match field {
            "sphere" => return atom(text),
            "hit" => return atom(text.replace("&scene.spheres,", "&scene.sphere_points,")),
            _ => {}
        }
        let of = match &self.shader.module.types[member].inner {
            inner @ TypeInner::Scalar(_) => shared(inner).into(),
            inner @ TypeInner::Vector { size, .. } => {
                format!("vec{}{}", *size as u8, of_parts(inner))
            }
            _ => self.fail("a member", expression),
        };
        let record = self.type_handle(base).and_then(|ty| self.shader.record(ty));
        let record = record.unwrap_or_else(|| self.fail("a member", expression));
        atom(format!(
            "{text}.{of}(offset_of!(records::{record}, {field}))"
        ))
    }

    fn type_handle(&self, expression: Handle<Expression>) -> Option<Handle<Type>> {
        match &self.shader.info[self.handle][expression].ty {
            TypeResolution::Handle(ty) => Some(*ty),
            TypeResolution::Value(TypeInner::Pointer { base, .. }) => Some(*base),
            TypeResolution::Value(_) => None,
        }
    }
}

/// A component of a vector that each lane reads from its own record: the others need not be read.
fn one_of_gathered(text: &str, index: u32) -> Option<String> {
    let (of, field) = text.strip_suffix(')')?.split_once("(offset_of!")?;
    let (record, vector) = of.rsplit_once('.')?;
    let (scalar, size) = match vector {
        "vec2" | "vec3" | "vec4" => ("f32", size_of::<f32>()),
        "vec2_f64" | "vec3_f64" | "vec4_f64" => ("f64", size_of::<f64>()),
        "vec2_u32" => ("u32", size_of::<u32>()),
        _ => return None,
    };
    let place = match index {
        0 => String::new(),
        _ => format!(" + {}", index as usize * size),
    };
    Some(format!("{record}.{scalar}(offset_of!{field}{place})"))
}
