//! Which expressions of a function are the same in all lanes.

use std::collections::BTreeSet;

use naga::proc::TypeResolution;
use naga::{AddressSpace, Expression, Function, Handle, LocalVariable, Statement, TypeInner};

use super::module::{Shader, inner_blocks, name, root};

/// What an expression is in Rust.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A number or truth that all lanes share.
    Shared,
    /// A vector that all lanes share, as an array.
    Array,
    /// A record of a buffer that all lanes share.
    Record,
    /// A record of a buffer for each lane.
    Gathered,
    /// A value for each lane.
    Lanes,
    /// A variable, or a part of one.
    Place,
}

/// What is known of a function's expressions and variables.
pub(super) struct Kinds {
    pub(super) of: Vec<Kind>,
    /// Variables that all lanes share.
    pub(super) shared: BTreeSet<Handle<LocalVariable>>,
}

impl Kinds {
    pub(super) fn new(shader: &Shader<'_>, handle: Handle<Function>) -> Self {
        let function = &shader.module.functions[handle];
        let scalar = |ty| matches!(shader.module.types[ty].inner, TypeInner::Scalar(_));
        let locals = function.local_variables.iter();
        let mut kinds = Self {
            of: Vec::new(),
            shared: locals
                .filter(|(_, local)| scalar(local.ty))
                .map(|(handle, _)| handle)
                .collect(),
        };
        // Variables are taken for shared until something is stored that is not, or where not all lanes do.
        loop {
            kinds.of.clear();
            for (expression, _) in function.expressions.iter() {
                let kind = kinds.kind(shader, handle, expression);
                kinds.of.push(kind);
            }
            let mut varying = BTreeSet::new();
            kinds.stores(function, &function.body, false, &mut varying);
            let before = kinds.shared.len();
            kinds.shared.retain(|local| !varying.contains(local));
            if kinds.shared.len() == before {
                return kinds;
            }
        }
    }

    pub(super) fn get(&self, expression: Handle<Expression>) -> Kind {
        self.of[expression.index()]
    }

    pub(super) fn is_shared(&self, expression: Handle<Expression>) -> bool {
        self.get(expression) == Kind::Shared
    }

    fn kind(
        &self,
        shader: &Shader<'_>,
        handle: Handle<Function>,
        expression: Handle<Expression>,
    ) -> Kind {
        let function = &shader.module.functions[handle];
        let inner = match &shader.info[handle][expression].ty {
            TypeResolution::Handle(ty) => &shader.module.types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        };
        let scalar = matches!(inner, TypeInner::Scalar(_));
        let all_shared = |operands: &[Handle<Expression>]| {
            if scalar && operands.iter().all(|operand| self.is_shared(*operand)) {
                Kind::Shared
            } else {
                Kind::Lanes
            }
        };
        match &function.expressions[expression] {
            Expression::Literal(_)
            | Expression::Override(_)
            | Expression::Constant(_)
            | Expression::ZeroValue(_) => all_shared(&[]),
            Expression::FunctionArgument(number) => {
                let argument = &function.arguments[*number as usize];
                let uniform = shader
                    .told
                    .uniform
                    .iter()
                    .any(|(f, a)| *f == name(function) && Some(*a) == argument.name.as_deref());
                let record = shader.record(argument.ty).is_some();
                match (inner, record, uniform) {
                    (TypeInner::Pointer { .. }, ..) => Kind::Place,
                    (_, true, true) => Kind::Record,
                    (_, true, false) => Kind::Gathered,
                    (_, false, true) => Kind::Shared,
                    (_, false, false) => Kind::Lanes,
                }
            }
            Expression::GlobalVariable(global) => {
                let global = &shader.module.global_variables[*global];
                let vector = matches!(
                    shader.module.types[global.ty].inner,
                    TypeInner::Vector { .. }
                );
                match global.space {
                    AddressSpace::Private if vector => Kind::Array,
                    AddressSpace::Private => match global.name.as_deref() {
                        Some("steps") => Kind::Shared,
                        _ => Kind::Place,
                    },
                    _ => Kind::Record,
                }
            }
            Expression::LocalVariable(local) if self.shared.contains(local) => Kind::Shared,
            Expression::LocalVariable(_) => Kind::Place,
            Expression::Access { base, index } => match (self.get(*base), self.is_shared(*index)) {
                (Kind::Record, false) => Kind::Gathered,
                (Kind::Record, true) => member_kind(shader, inner),
                (kind, _) => kind,
            },
            Expression::AccessIndex { base, .. } => match self.get(*base) {
                Kind::Record => member_kind(shader, inner),
                Kind::Array => Kind::Shared,
                Kind::Gathered if !is_place(inner) && !is_struct(shader, inner) => Kind::Lanes,
                Kind::Lanes if is_record(shader, inner, &shader.info[handle][expression].ty) => {
                    Kind::Gathered
                }
                kind => kind,
            },
            Expression::Load { pointer } => match self.get(*pointer) {
                Kind::Place => Kind::Lanes,
                Kind::Gathered if !is_struct(shader, inner) => Kind::Lanes,
                kind => kind,
            },
            Expression::Unary { expr, .. } | Expression::As { expr, .. } => all_shared(&[*expr]),
            Expression::Binary { left, right, .. } => all_shared(&[*left, *right]),
            Expression::Select {
                condition,
                accept,
                reject,
            } => all_shared(&[*condition, *accept, *reject]),
            Expression::Math {
                arg, arg1, arg2, ..
            } => {
                let operands: Vec<_> = [Some(*arg), *arg1, *arg2].into_iter().flatten().collect();
                all_shared(&operands)
            }
            _ => Kind::Lanes,
        }
    }

    /// Notes the variables into which something is stored that lanes do not share, or where not all of them do.
    fn stores(
        &self,
        function: &Function,
        block: &[Statement],
        diverged: bool,
        varying: &mut BTreeSet<Handle<LocalVariable>>,
    ) {
        for statement in block {
            match statement {
                Statement::Store { pointer, value } => {
                    if let Expression::LocalVariable(local) = root(function, *pointer)
                        && (diverged || !self.is_shared(*value))
                    {
                        varying.insert(*local);
                    }
                }
                Statement::Call { arguments, .. } => {
                    for argument in arguments {
                        if let Expression::LocalVariable(local) = root(function, *argument) {
                            varying.insert(*local);
                        }
                    }
                }
                _ => {}
            }
            let diverged = diverged || !self.is_uniform(statement);
            for inner in inner_blocks(statement) {
                self.stores(function, inner, diverged, varying);
            }
        }
    }

    /// Whether all lanes go the same way through a statement.
    pub(super) fn is_uniform(&self, statement: &Statement) -> bool {
        match statement {
            Statement::If { condition, .. } => self.is_shared(*condition),
            Statement::Switch { selector, .. } => self.is_shared(*selector),
            Statement::Loop { body, break_if, .. } => {
                break_if.is_none_or(|condition| self.is_shared(condition))
                    && self.leaves_together(body)
            }
            _ => true,
        }
    }

    /// Whether no lane leaves a loop's body by itself.
    fn leaves_together(&self, block: &[Statement]) -> bool {
        block.iter().all(|statement| {
            let inner = inner_blocks(statement);
            let exits = inner.iter().any(|block| exits(block));
            match statement {
                // Inner loops keep their own ends, but for returns.
                Statement::Loop { .. } => !inner.iter().any(|block| returns(block)),
                _ => {
                    (!exits || self.is_uniform(statement))
                        && inner.iter().all(|block| self.leaves_together(block))
                }
            }
        })
    }
}

/// Whether lanes leave the block's loop or function in it.
pub(super) fn exits(block: &[Statement]) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Break | Statement::Continue | Statement::Return { .. } => true,
        Statement::Loop { .. } => inner_blocks(statement).into_iter().any(returns),
        _ => inner_blocks(statement).into_iter().any(exits),
    })
}

/// Whether lanes leave the function in it.
pub(super) fn returns(block: &[Statement]) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::Return { .. })
            || inner_blocks(statement).into_iter().any(returns)
    })
}

fn is_place(inner: &TypeInner) -> bool {
    matches!(
        inner,
        TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }
    )
}

fn is_struct(shader: &Shader<'_>, inner: &TypeInner) -> bool {
    match inner {
        TypeInner::Struct { .. } => true,
        TypeInner::Pointer { base, .. } => is_struct(shader, &shader.module.types[*base].inner),
        _ => false,
    }
}

fn is_record(shader: &Shader<'_>, inner: &TypeInner, resolution: &TypeResolution) -> bool {
    match (inner, resolution) {
        (TypeInner::Struct { .. }, TypeResolution::Handle(ty)) => shader.record(*ty).is_some(),
        _ => false,
    }
}

/// What a member of a shared record is.
fn member_kind(shader: &Shader<'_>, inner: &TypeInner) -> Kind {
    match inner {
        TypeInner::Scalar(_) | TypeInner::ValuePointer { size: None, .. } => Kind::Shared,
        TypeInner::Vector { .. } | TypeInner::ValuePointer { .. } => Kind::Array,
        TypeInner::Pointer { base, .. } => member_kind(shader, &shader.module.types[*base].inner),
        _ => Kind::Record,
    }
}
