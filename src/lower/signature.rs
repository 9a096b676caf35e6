//! What functions and structs look like in Rust.

use std::fmt::Write as _;

use naga::{Expression, Function, Handle, Scalar, ScalarKind, Statement, Type, TypeInner};

use super::kinds::{Kinds, exits};
use super::module::{Shader, each_statement, inner_blocks, name, root};
use crate::shader::bounds;

impl Shader<'_> {
    /// The type for each lane.
    pub(super) fn rust_type(&self, ty: Handle<Type>) -> String {
        let scalar = |scalar: Scalar| match scalar.kind {
            ScalarKind::Float if scalar.width == 8 => "D<S>",
            ScalarKind::Float => "F<S>",
            ScalarKind::Uint => "U<S>",
            ScalarKind::Sint => "I<S>",
            _ => "M<S>",
        };
        if let Some(record) = self.record(ty) {
            return format!("Gather<'a, records::{record}, S>");
        }
        match &self.module.types[ty].inner {
            TypeInner::Scalar(one) => scalar(*one).into(),
            TypeInner::Vector { size, scalar: one } => {
                format!("Vec{}<{}>", *size as u8, scalar(*one))
            }
            TypeInner::Pointer { base, .. } => format!("&mut {}", self.rust_type(*base)),
            TypeInner::Struct { .. } if self.has_record(ty) => {
                format!("{}<'a, S>", self.type_name(ty).unwrap_or_default())
            }
            TypeInner::Struct { .. } => format!("{}<S>", self.type_name(ty).unwrap_or_default()),
            other => panic!("a type without lanes: {other:?}"),
        }
    }

    /// Whether a struct has a record of a buffer in it.
    fn has_record(&self, ty: Handle<Type>) -> bool {
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => members
                .iter()
                .any(|member| self.record(member.ty).is_some()),
            _ => false,
        }
    }

    /// A number that the host knows: a constant of the bounds, or what the scene has.
    pub(super) fn constant(&self, name: &str) -> String {
        if bounds::NAMED.iter().any(|constant| constant.name == name) {
            format!("constants::{name}")
        } else {
            // What counts a buffer's elements must not have the buffer's name.
            let count = ["LIGHTS", "PLANES", "POLYGONS", "SPHERES"].contains(&name);
            format!(
                "scene.{}{}",
                name.to_lowercase(),
                if count { "_count" } else { "" }
            )
        }
    }

    pub(super) fn struct_text(&self, struct_name: &str, ty: Handle<Type>) -> String {
        let TypeInner::Struct { members, .. } = &self.module.types[ty].inner else {
            return String::new();
        };
        let mut text = String::from("\n");
        let comment = self.comment(&format!("struct {struct_name} "));
        let docs: String = comment.iter().map(|line| format!("/// {line}\n")).collect();
        let fields: Vec<_> = members
            .iter()
            .map(|member| {
                let field = member.name.as_deref().unwrap_or_default();
                (field, self.rust_type(member.ty))
            })
            .collect();
        if self.has_record(ty) {
            let lines: String = fields
                .iter()
                .map(|(field, ty)| format!("    pub {field}: {ty},\n"))
                .collect();
            let _ = write!(
                text,
                "{docs}#[derive(Clone, Copy)]\npub(super) struct {struct_name}<'a, S: Simd> {{\n{lines}}}\n"
            );
        } else {
            let lines: String = fields
                .iter()
                .map(|(field, ty)| format!("    {field}: {ty},\n"))
                .collect();
            let _ = write!(text, "record! {{\n{docs}{struct_name} {{\n{lines}}}\n}}\n");
        }
        text
    }

    /// Finds out what a function takes beside its arguments; callees were asked before.
    pub(super) fn note_needs(&mut self, handle: Handle<Function>) {
        let function = &self.module.functions[handle];
        let own = name(function).to_string();
        let kinds = Kinds::new(self, handle);
        let (mut state, mut on) = (false, false);
        each_statement(&function.body, &mut |statement| match statement {
            Statement::Call { function, .. } => {
                let called = name(&self.module.functions[*function]);
                state |= self.state.contains(called);
                on |= self.on.contains(called);
            }
            Statement::Store { pointer, .. } => match root(function, *pointer) {
                Expression::GlobalVariable(global) => {
                    let steps = self.module.global_variables[*global].name.as_deref();
                    state |= steps != Some("steps");
                    on |= steps != Some("steps");
                }
                Expression::FunctionArgument(_) => {
                    on |= !self.told.unmasked.contains(&own.as_str());
                }
                _ => {}
            },
            statement => {
                on |= !kinds.is_uniform(statement);
                on |= inner_blocks(statement).iter().any(|block| exits(block));
            }
        });
        for (expression, of) in function.expressions.iter() {
            if let (Expression::GlobalVariable(_), super::kinds::Kind::Place) =
                (of, kinds.get(expression))
            {
                state = true;
            }
        }
        if state {
            self.state.insert(own.clone());
        }
        if on {
            self.on.insert(own);
        }
    }

    /// The function's head, up to its result.
    pub(super) fn head(&self, function: &Function) -> String {
        let own = name(function);
        let mut arguments = vec!["scene: &'a Scene<'a, S>".to_string()];
        if self.state.contains(own) {
            arguments.push("state: &mut State<S>".into());
        }
        if self.on.contains(own) {
            arguments.push("on: M<S>".into());
        }
        for argument in &function.arguments {
            let of = argument.name.as_deref().unwrap_or_default();
            let uniform = self.told.uniform.contains_pair(own, of);
            let ty = match (self.record(argument.ty), uniform) {
                (Some(record), true) => format!("&records::{record}"),
                (None, true) => shared(&self.module.types[argument.ty].inner).into(),
                _ => self.rust_type(argument.ty),
            };
            arguments.push(format!("{of}: {ty}"));
        }
        let result = function
            .result
            .as_ref()
            .map(|result| self.rust_type(result.ty));
        let result = result.map_or(String::new(), |ty| format!(" -> {ty}"));
        format!(
            "pub(super) fn {own}<'a, S: Simd>({}){result}",
            arguments.join(", ")
        )
    }
}

/// The type of a number or truth that all lanes share.
pub(super) fn shared(inner: &TypeInner) -> &'static str {
    match inner.scalar() {
        Some(Scalar {
            kind: ScalarKind::Float,
            width: 8,
        }) => "f64",
        Some(Scalar {
            kind: ScalarKind::Float,
            ..
        }) => "f32",
        Some(Scalar {
            kind: ScalarKind::Uint,
            ..
        }) => "u32",
        Some(Scalar {
            kind: ScalarKind::Sint,
            ..
        }) => "i32",
        _ => "bool",
    }
}

trait ContainsPair {
    fn contains_pair(&self, a: &str, b: &str) -> bool;
}

impl ContainsPair for &[(&str, &str)] {
    fn contains_pair(&self, a: &str, b: &str) -> bool {
        self.iter().any(|(f, g)| *f == a && *g == b)
    }
}
