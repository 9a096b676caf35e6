//! A composed shader as naga reads it, and what the lowering is told of it.

use std::collections::{BTreeMap, BTreeSet};

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Expression, Function, Handle, Module, Statement, Type, TypeInner};

/// What is known of a function that is written by hand.
#[derive(Debug, Clone, Copy)]
pub(super) struct ByHand {
    pub(super) name: &'static str,
    /// Whether it takes what is private to lanes.
    pub(super) state: bool,
    /// Whether it takes the mask of the lanes that ask.
    pub(super) on: bool,
    /// Whether it goes on to the text's own function.
    pub(super) goes_on: bool,
}

/// What the lowering is told of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    /// Whether it is one in f64.
    pub(super) double: bool,
    /// The functions that are called from outside.
    pub(super) roots: &'static [&'static str],
    /// The functions that are called from inside and written outside.
    pub(super) by_hand: &'static [ByHand],
    /// Arguments that are the same in all lanes: the function and the argument.
    pub(super) uniform: &'static [(&'static str, &'static str)],
    /// Functions that are too long to be written into each of their callers.
    pub(super) apart: &'static [&'static str],
    /// Functions whose pointers lead to what lanes that are off need no more.
    pub(super) unmasked: &'static [&'static str],
    /// Functions that hand their argument on: Rust's compiler does not look through roundings.
    pub(super) identity: &'static [&'static str],
    /// What the scene has in the place of `objects`.
    pub(super) objects: &'static str,
    /// Structs of buffers, and the Rust structs that they are.
    pub(super) records: &'static [(&'static str, &'static str)],
}

/// A shader to be lowered.
pub(super) struct Shader<'a> {
    pub(super) module: Module,
    pub(super) info: ModuleInfo,
    pub(super) wgsl: &'a str,
    pub(super) told: Told,
    /// Functions that take what is private to lanes, and those that take a mask.
    pub(super) state: BTreeSet<String>,
    pub(super) on: BTreeSet<String>,
}

impl<'a> Shader<'a> {
    pub(super) fn new(wgsl: &'a str, told: Told) -> Self {
        let module = naga::front::wgsl::parse_str(wgsl)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(wgsl)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::all())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(wgsl)));
        let by_hand = |asks: fn(&ByHand) -> bool| {
            let those = told.by_hand.iter().filter(|function| asks(function));
            those.map(|function| function.name.to_string()).collect()
        };
        Self {
            module,
            info,
            wgsl,
            told,
            state: by_hand(|function| function.state),
            on: by_hand(|function| function.on),
        }
    }

    /// The functions to be written, callees first.
    pub(super) fn functions(&self) -> Vec<Handle<Function>> {
        let mut wanted: BTreeSet<&str> = self.told.roots.iter().copied().collect();
        let mut handles: Vec<_> = self.module.functions.iter().collect();
        // Callees stand before their callers.
        handles.reverse();
        let mut found = Vec::new();
        for (handle, function) in handles {
            let name = name(function);
            if !wanted.contains(name) || self.is_by_hand(name) {
                continue;
            }
            found.push(handle);
            for called in self.called(function) {
                wanted.insert(called);
            }
        }
        found.reverse();
        found
    }

    /// Whether it is not written.
    fn is_by_hand(&self, function: &str) -> bool {
        let found = self.told.by_hand.iter().find(|f| f.name == function);
        found.is_some_and(|f| !f.goes_on) || self.told.identity.contains(&function)
    }

    /// Whether what is called stands outside of the text.
    pub(super) fn is_outside(&self, function: &str) -> bool {
        self.told.by_hand.iter().any(|f| f.name == function)
    }

    /// The functions that a function calls.
    pub(super) fn called<'s>(&'s self, function: &'s Function) -> Vec<&'s str> {
        let mut all = Vec::new();
        each_statement(&function.body, &mut |statement| {
            if let Statement::Call { function, .. } = statement {
                all.push(name(&self.module.functions[*function]));
            }
        });
        all
    }

    pub(super) fn type_name(&self, ty: Handle<Type>) -> Option<&str> {
        self.module.types[ty].name.as_deref()
    }

    /// The Rust struct of a buffer's struct.
    pub(super) fn record(&self, ty: Handle<Type>) -> Option<&'static str> {
        let name = self.type_name(ty)?;
        let found = self.told.records.iter().find(|(wgsl, _)| *wgsl == name)?;
        Some(found.1)
    }

    /// The comment that stands before a declaration.
    pub(super) fn comment(&self, declaration: &str) -> Vec<&str> {
        let Some(at) = self.wgsl.find(&format!("\n{declaration}")) else {
            return Vec::new();
        };
        let before = self.wgsl[..at].lines().rev();
        let mut lines: Vec<_> = before
            .take_while(|line| line.starts_with("//"))
            .map(|line| line.trim_start_matches('/').trim())
            .collect();
        lines.reverse();
        lines
    }

    /// The structs that functions name, those of buffers left out.
    pub(super) fn structs(&self) -> BTreeMap<String, Handle<Type>> {
        let mut found = BTreeMap::new();
        for handle in self.functions() {
            let function = &self.module.functions[handle];
            let arguments = function.arguments.iter().map(|argument| argument.ty);
            let results = function.result.iter().map(|result| result.ty);
            let locals = function.local_variables.iter().map(|(_, local)| local.ty);
            for ty in arguments.chain(results).chain(locals) {
                self.note_struct(ty, &mut found);
            }
        }
        found
    }

    fn note_struct(&self, ty: Handle<Type>, found: &mut BTreeMap<String, Handle<Type>>) {
        match &self.module.types[ty].inner {
            TypeInner::Pointer { base, .. } => self.note_struct(*base, found),
            TypeInner::Struct { members, .. } if self.record(ty).is_none() => {
                found.insert(self.type_name(ty).unwrap_or_default().into(), ty);
                for member in members {
                    self.note_struct(member.ty, found);
                }
            }
            _ => {}
        }
    }
}

pub(super) fn name(function: &Function) -> &str {
    function.name.as_deref().unwrap_or_default()
}

/// All statements, those within others too.
pub(super) fn each_statement<'s>(block: &'s [Statement], of: &mut impl FnMut(&'s Statement)) {
    for statement in block {
        of(statement);
        for inner in inner_blocks(statement) {
            each_statement(inner, of);
        }
    }
}

pub(super) fn inner_blocks(statement: &Statement) -> Vec<&[Statement]> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body[..]).collect(),
        Statement::Loop {
            body, continuing, ..
        } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// The variable that a pointer leads to, through members.
pub(super) fn root(function: &Function, pointer: Handle<Expression>) -> &Expression {
    match &function.expressions[pointer] {
        Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
            root(function, *base)
        }
        other => other,
    }
}
