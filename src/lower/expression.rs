//! Expressions as Rust.

use naga::proc::TypeResolution;
use naga::{
    Expression, Handle, Literal, RelationalFunction, ScalarKind, SwizzleComponent, Type, TypeInner,
    UnaryOperator,
};

use super::kinds::Kind;
use super::signature::shared;
use super::statement::Writer;

/// A piece of Rust, and how tightly it holds together.
#[derive(Debug, Clone)]
pub(super) struct Text {
    pub(super) rust: String,
    pub(super) binding: u8,
}

pub(super) const ATOM: u8 = 20;
pub(super) const UNARY: u8 = 15;
pub(super) const CAST: u8 = 14;

pub(super) fn atom(rust: impl Into<String>) -> Text {
    Text {
        rust: rust.into(),
        binding: ATOM,
    }
}

impl Text {
    /// As an operand of what binds so tightly.
    pub(super) fn within(&self, binding: u8) -> String {
        if self.binding >= binding {
            self.rust.clone()
        } else {
            format!("({})", self.rust)
        }
    }
}

/// What the names of vectors' functions end with, by what the vectors are of: nothing for `f32`.
pub(super) fn of_parts(inner: &TypeInner) -> String {
    match shared(inner) {
        "f32" => String::new(),
        number => format!("_{number}"),
    }
}

pub(super) const PARTS: [&str; 4] = ["x", "y", "z", "w"];

impl Writer<'_> {
    pub(super) fn inner(&self, expression: Handle<Expression>) -> &TypeInner {
        match &self.shader.info[self.handle][expression].ty {
            TypeResolution::Handle(ty) => &self.shader.module.types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        }
    }

    /// An expression for each lane.
    pub(super) fn lanes(&self, expression: Handle<Expression>) -> Text {
        let text = self.expression(expression);
        let inner = self.inner(expression);
        match self.kinds.get(expression) {
            Kind::Shared => {
                let of = match shared(inner) {
                    "bool" => "mask",
                    number => number,
                };
                atom(format!("scene.{of}({})", text.rust))
            }
            Kind::Array => {
                let TypeInner::Vector { size, .. } = inner else {
                    self.fail("an array", expression)
                };
                atom(format!(
                    "scene.vec{}{}({})",
                    *size as u8,
                    of_parts(inner),
                    text.rust
                ))
            }
            _ => text,
        }
    }

    /// An expression as it is, numbers that all lanes share as numbers of Rust.
    pub(super) fn expression(&self, expression: Handle<Expression>) -> Text {
        if let Some(name) = self.baked.get(&expression) {
            return atom(name.clone());
        }
        let shared = self.kinds.is_shared(expression);
        match &self.function.expressions[expression] {
            Expression::Literal(literal) => self.literal(*literal, expression),
            Expression::Constant(constant) => {
                let constant = &self.shader.module.constants[*constant];
                match &constant.name {
                    Some(name) => atom(format!("constants::{name}")),
                    None => self.fail("a constant without a name", expression),
                }
            }
            Expression::Override(one) => {
                let name = self.shader.module.overrides[*one].name.as_deref();
                atom(self.shader.constant(name.unwrap_or_default()))
            }
            Expression::ZeroValue(ty) => self.zero(*ty, shared),
            Expression::Compose { ty, components } => self.compose(*ty, components),
            Expression::Splat { size, value } => {
                let value = self.lanes(*value).rust;
                atom(format!("Vec{}::splat({value})", *size as u8))
            }
            Expression::Swizzle {
                size,
                vector,
                pattern,
            } => self.swizzle(*size as usize, *vector, pattern),
            Expression::FunctionArgument(number) => {
                let name = self.function.arguments[*number as usize].name.as_deref();
                atom(name.unwrap_or_default())
            }
            Expression::LocalVariable(local) => atom(self.local(*local)),
            Expression::GlobalVariable(global) => {
                let name = self.shader.module.global_variables[*global].name.as_deref();
                let name = name.unwrap_or_default();
                match self.kinds.get(expression) {
                    Kind::Place => atom(format!("state.{name}")),
                    Kind::Shared => atom("0"),
                    _ if name == "objects" => atom(format!("scene.{}", self.shader.told.objects)),
                    _ => atom(format!("scene.{}", name.to_lowercase())),
                }
            }
            Expression::Load { pointer } => self.load(*pointer),
            Expression::Access { base, index } => self.access(expression, *base, *index),
            Expression::AccessIndex { base, index } => self.member(expression, *base, *index),
            Expression::Unary { op, expr } => {
                let of = if shared {
                    self.expression(*expr)
                } else {
                    self.lanes(*expr)
                };
                let of = of.within(UNARY);
                let op = match op {
                    UnaryOperator::Negate => '-',
                    UnaryOperator::LogicalNot | UnaryOperator::BitwiseNot => '!',
                };
                Text {
                    rust: format!("{op}{of}"),
                    binding: UNARY,
                }
            }
            Expression::Binary { op, left, right } => self.binary(shared, *op, *left, *right),
            Expression::Select {
                condition,
                accept,
                reject,
            } if shared => {
                let [condition, accept, reject] =
                    [condition, accept, reject].map(|e| self.expression(*e).rust);
                atom(format!(
                    "(if {condition} {{ {accept} }} else {{ {reject} }})"
                ))
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let condition = self.lanes(*condition).within(ATOM);
                let [accept, reject] = [accept, reject].map(|e| self.lanes(*e).rust);
                atom(format!("{condition}.select({accept}, {reject})"))
            }
            Expression::Relational { fun, argument } => {
                let fun = match fun {
                    RelationalFunction::All => "all",
                    RelationalFunction::Any => "any_of",
                    _ => self.fail("a relation", expression),
                };
                atom(format!("{}.{fun}()", self.lanes(*argument).within(ATOM)))
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                ..
            } => {
                let operands: Vec<_> = [Some(*arg), *arg1, *arg2].into_iter().flatten().collect();
                self.math(expression, *fun, &operands, shared)
            }
            Expression::As {
                expr,
                kind,
                convert,
            } => self.cast(expression, *expr, (*kind, *convert), shared),
            Expression::CallResult(_) => self.fail("the result of a call", expression),
            _ => self.fail("an expression", expression),
        }
    }

    fn literal(&self, literal: Literal, expression: Handle<Expression>) -> Text {
        match literal {
            Literal::F32(value) if value.is_sign_negative() => Text {
                rust: format!("{value:?}"),
                binding: UNARY,
            },
            Literal::F32(value) => atom(format!("{value:?}")),
            Literal::F64(value) if value.is_sign_negative() => Text {
                rust: format!("{value:?}"),
                binding: UNARY,
            },
            Literal::F64(value) => atom(format!("{value:?}")),
            Literal::U32(value) => atom(format!("{value}")),
            Literal::I32(value) if value < 0 => Text {
                rust: format!("{value}"),
                binding: UNARY,
            },
            Literal::I32(value) => atom(format!("{value}")),
            Literal::Bool(value) => atom(format!("{value}")),
            _ => self.fail("a literal", expression),
        }
    }

    fn zero(&self, ty: Handle<Type>, shared: bool) -> Text {
        if shared {
            return match self.shader.module.types[ty].inner.scalar_kind() {
                Some(ScalarKind::Float) => atom("0.0"),
                Some(ScalarKind::Bool) => atom("false"),
                _ => atom("0"),
            };
        }
        atom(format!("<{}>::zero(scene.simd)", self.shader.rust_type(ty)))
    }

    fn compose(&self, ty: Handle<Type>, components: &[Handle<Expression>]) -> Text {
        let parts: Vec<_> = components.iter().map(|part| self.part(*part)).collect();
        match &self.shader.module.types[ty].inner {
            TypeInner::Vector { size, .. } => {
                // A vector may be made of shorter ones.
                let mut all = Vec::new();
                for (component, text) in components.iter().zip(parts) {
                    match self.inner(*component) {
                        TypeInner::Vector { size, .. } => {
                            let whole = self.lanes(*component).within(ATOM);
                            let of = |i: usize| format!("{whole}.{}", PARTS[i]);
                            all.extend((0..*size as usize).map(of));
                        }
                        _ => all.push(text),
                    }
                }
                atom(format!("Vec{}::new({})", *size as u8, all.join(", ")))
            }
            TypeInner::Struct { members, .. } => {
                let name = self.shader.type_name(ty).unwrap_or_default();
                let fields: Vec<_> = members
                    .iter()
                    .zip(parts)
                    .map(|(member, part)| {
                        let field = member.name.as_deref().unwrap_or_default();
                        if field == part {
                            part
                        } else {
                            format!("{field}: {part}")
                        }
                    })
                    .collect();
                atom(format!("{name} {{ {} }}", fields.join(", ")))
            }
            _ => atom("unsupported!()"),
        }
    }

    /// A part of a struct or an argument of a call.
    fn part(&self, expression: Handle<Expression>) -> String {
        match self.kinds.get(expression) {
            Kind::Gathered => self.expression(expression).rust,
            _ => self.lanes(expression).within(2),
        }
    }

    fn swizzle(
        &self,
        size: usize,
        vector: Handle<Expression>,
        pattern: &[SwizzleComponent; 4],
    ) -> Text {
        let text = self.lanes(vector);
        let simple = text
            .rust
            .chars()
            .all(|c| c.is_alphanumeric() || "_.".contains(c));
        let of = if simple { text.rust.as_str() } else { "v" };
        let parts: Vec<_> = pattern[..size]
            .iter()
            .map(|part| format!("{of}.{}", PARTS[*part as usize]))
            .collect();
        let swizzled = format!("Vec{size}::new({})", parts.join(", "));
        if simple {
            atom(swizzled)
        } else {
            atom(format!("{{ let v = {}; {swizzled} }}", text.rust))
        }
    }
}
