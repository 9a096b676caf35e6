//! Statements as Rust: where lanes go different ways, both ways are gone, each by the lanes that want it.
//!
//! `on` has the lanes that are here. What is stored is stored by them; where a lane leaves the function or a loop
//! early, it is noted in `gone`, and is on no more.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use naga::{Expression, Function, Handle, LocalVariable, Statement, SwitchValue};

use super::kinds::{Kind, Kinds, exits, returns};
use super::module::{Shader, inner_blocks, name, root};
use super::signature::shared as type_of_shared;
use super::variables::{Regions, address};

/// Writes a function.
pub(super) struct Writer<'a> {
    pub(super) shader: &'a Shader<'a>,
    pub(super) function: &'a Function,
    pub(super) handle: Handle<Function>,
    pub(super) kinds: Kinds,
    /// Expressions that have names.
    pub(super) baked: BTreeMap<Handle<Expression>, String>,
    /// Loads that stand in no text yet.
    pub(super) pending: BTreeSet<Handle<Expression>>,
    pub(super) names: BTreeSet<String>,
    pub(super) locals: BTreeMap<Handle<LocalVariable>, String>,
    pub(super) declared: BTreeSet<Handle<LocalVariable>>,
    /// The part of the function, between divergences, that a variable belongs to.
    pub(super) homes: BTreeMap<Handle<LocalVariable>, usize>,
    pub(super) regions: Regions,
    pub(super) text: String,
    /// The loops around: whether each is gone round by all lanes together.
    pub(super) loops: Vec<bool>,
    pub(super) region: usize,
    pub(super) depth: usize,
}

impl<'a> Writer<'a> {
    pub(super) fn function(shader: &'a Shader<'a>, handle: Handle<Function>) -> String {
        let function = &shader.module.functions[handle];
        let mut writer = Self {
            shader,
            function,
            handle,
            kinds: Kinds::new(shader, handle),
            baked: BTreeMap::new(),
            pending: BTreeSet::new(),
            names: ["scene", "state", "on", "gone", "result", "here"]
                .map(String::from)
                .into(),
            locals: BTreeMap::new(),
            declared: BTreeSet::new(),
            homes: BTreeMap::new(),
            regions: Regions::default(),
            text: String::new(),
            loops: Vec::new(),
            region: 0,
            depth: 1,
        };
        writer.whole()
    }

    pub(super) fn fail(&self, what: &str, expression: Handle<Expression>) -> ! {
        panic!(
            "{}: {what} that has no meaning for lanes: {:?}",
            name(self.function),
            self.function.expressions[expression]
        );
    }

    pub(super) fn local(&self, local: Handle<LocalVariable>) -> String {
        self.locals.get(&local).cloned().unwrap_or_default()
    }

    pub(super) fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{}{line}", "    ".repeat(self.depth));
    }

    pub(super) fn fresh(&mut self, wish: &str) -> String {
        // What is a name in WGSL may be a word of Rust.
        let taken = ["in", "ref", "move", "mut", "where", "self", "impl", "dyn"].contains(&wish);
        let wish = if taken {
            format!("{wish}_")
        } else {
            wish.into()
        };
        let mut name = wish.clone();
        let mut number = 2;
        while !self.names.insert(name.clone()) {
            name = format!("{wish}_{number}");
            number += 1;
        }
        name
    }

    fn whole(&mut self) -> String {
        let own = name(self.function).to_string();
        for argument in &self.function.arguments {
            let argument = argument.name.clone().unwrap_or_default();
            let of_masks = ["gone_", "looping_"]
                .iter()
                .any(|start| argument.starts_with(start));
            if of_masks || !self.names.insert(argument.clone()) {
                panic!("{own}: an argument called {argument}");
            }
        }
        for (handle, local) in self.function.local_variables.iter() {
            let name = self.fresh(local.name.as_deref().unwrap_or("local"));
            self.locals.insert(handle, name);
        }
        for (_, function) in self.shader.module.functions.iter() {
            self.names.insert(name(function).to_string());
        }
        self.find_homes();
        let early = self.leaves_early();
        self.declare();
        let result = self.function.result.as_ref();
        if early {
            if let Some(result) = result {
                let ty = self.shader.rust_type(result.ty);
                self.line(&format!("let mut result = <{ty}>::zero(scene.simd);"));
            }
            self.line("let mut on = on;");
            self.line("let mut gone = scene.mask(false);");
        }
        self.block(&self.function.body, true, early);
        let mut body = std::mem::take(&mut self.text);
        if self.shader.told.apart.contains(&own.as_str()) {
            body = format!("    scene.simd.vectorize(#[inline(always)] || {{\n{body}    }})\n");
        }
        let comment = self.shader.comment(&format!("fn {own}("));
        let docs: String = comment.iter().map(|line| format!("/// {line}\n")).collect();
        let inline = if body.contains("vectorize") {
            ""
        } else {
            "#[inline(always)]\n"
        };
        let head = self.shader.head(self.function);
        format!("\n{docs}{inline}{head} {{\n{body}}}\n")
    }

    /// Whether a lane may leave the function before its end.
    pub(super) fn leaves_early(&self) -> bool {
        self.function
            .body
            .iter()
            .any(|statement| inner_blocks(statement).into_iter().any(returns))
    }

    /// Writes a block; `top` is the function's own.
    pub(super) fn block(&mut self, block: &'a [Statement], top: bool, early: bool) {
        let region = self.regions.of[&address(block)];
        let before = std::mem::replace(&mut self.region, region);
        for (i, statement) in block.iter().enumerate() {
            let last = i + 1 == block.len();
            self.statement(statement, top && last, early);
        }
        self.flush(|_| true);
        self.region = before;
        if top
            && early
            && !matches!(block.last(), Some(Statement::Return { .. }))
            && self.function.result.is_some()
        {
            self.line("result");
        }
    }

    fn statement(&mut self, statement: &'a Statement, last: bool, early: bool) {
        match statement {
            Statement::Emit(range) => {
                for expression in range.clone() {
                    self.emit(expression);
                }
            }
            Statement::Block(block) => self.block(block, false, early),
            Statement::Store { pointer, value } => self.store(*pointer, *value),
            Statement::Call {
                function,
                arguments,
                result,
            } => self.call(*function, arguments, *result),
            Statement::If {
                condition,
                accept,
                reject,
            } => self.branch(*condition, accept, reject),
            Statement::Switch { selector, cases } => {
                let selector = self.lanes(*selector).rust;
                self.flush(|_| true);
                let chosen = self.fresh("chosen");
                self.line(&format!("let {chosen} = {selector};"));
                let mut left = false;
                for case in cases {
                    let SwitchValue::U32(value) = case.value else {
                        if !case.body.is_empty() {
                            panic!("{}: a default case", name(self.function));
                        }
                        continue;
                    };
                    if case.fall_through || breaks(&case.body) {
                        panic!(
                            "{}: a case of several values, or with a break",
                            name(self.function)
                        );
                    }
                    self.line(&format!("let here = on & {chosen}.eq(scene.u32({value}));"));
                    self.masked(&case.body);
                    left |= exits(&case.body);
                }
                if left {
                    self.after_exits();
                }
            }
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => self.repeat(statement, body, continuing, *break_if),
            Statement::Break => {
                self.flush(|_| true);
                if self.loops.last() == Some(&true) {
                    self.line("break;");
                } else {
                    let level = self.loops.len();
                    self.line(&format!("looping_{level} = looping_{level} & !on;"));
                    self.line(&format!("gone_{level} = gone_{level} | on;"));
                }
            }
            Statement::Continue => {
                if self.loops.last() == Some(&true) {
                    panic!(
                        "{}: a round that all lanes leave early",
                        name(self.function)
                    );
                }
                self.flush(|_| true);
                let gone = self.gone();
                self.line(&format!("{gone} = {gone} | on;"));
            }
            Statement::Return { value } => self.leave(*value, last, early),
            other => panic!(
                "{}: a statement without lanes: {other:?}",
                name(self.function)
            ),
        }
    }

    /// Names what is to be named, and leaves the rest to where it is used.
    pub(super) fn emit(&mut self, expression: Handle<Expression>) {
        let of = &self.function.expressions[expression];
        let named = self.function.named_expressions.get(&expression);
        let uses = self.shader.info[self.handle][expression].ref_count;
        let load = matches!(of, Expression::Load { .. });
        let pointer = self.inner(expression).pointer_space().is_some();
        if pointer || uses == 0 {
            return;
        }
        let trivial = matches!(
            of,
            Expression::AccessIndex { base, .. } if self.kinds.get(*base) != Kind::Gathered
        );
        if named.is_some() || (uses > 1 && !trivial && !self.is_constant_place(expression)) {
            let wish = named.cloned().unwrap_or_else(|| "v".into());
            self.bake(expression, &wish);
        } else if load {
            self.pending.insert(expression);
        }
    }

    /// Whether it is a load of what never changes and costs nothing to name again.
    fn is_constant_place(&self, expression: Handle<Expression>) -> bool {
        let Expression::Load { pointer } = self.function.expressions[expression] else {
            return false;
        };
        let global = matches!(root(self.function, pointer), Expression::GlobalVariable(_));
        global && matches!(self.kinds.get(expression), Kind::Shared | Kind::Array)
    }

    fn bake(&mut self, expression: Handle<Expression>, wish: &str) {
        let text = match self.kinds.get(expression) {
            Kind::Record => format!("&{}", self.expression(expression).rust),
            _ => self.expression(expression).rust,
        };
        let name = self.fresh(wish);
        self.used(expression);
        self.line(&format!("let {name} = {text};"));
        self.baked.insert(expression, name);
    }

    /// Names loads that stand in no text yet, before what they load from may change.
    pub(super) fn flush(&mut self, which: impl Fn(&Expression) -> bool) {
        let pending: Vec<_> = self.pending.iter().copied().collect();
        for expression in pending {
            let Expression::Load { pointer } = self.function.expressions[expression] else {
                continue;
            };
            let from = root(self.function, pointer);
            let changes = match from {
                Expression::GlobalVariable(_) => self.kinds.get(pointer) == Kind::Place,
                _ => true,
            };
            if changes && which(from) {
                self.bake(expression, "v");
            }
        }
    }

    /// What stands in a text now needs no name any more.
    pub(super) fn used(&mut self, expression: Handle<Expression>) {
        self.pending.remove(&expression);
        if self.baked.contains_key(&expression) {
            return;
        }
        let operands = operands(&self.function.expressions[expression]);
        for operand in operands {
            self.used(operand);
        }
    }

    fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) {
        let from = root(self.function, pointer).clone();
        if let Expression::GlobalVariable(global) = &from
            && self.shader.module.global_variables[*global].name.as_deref() == Some("steps")
        {
            self.used(value);
            return;
        }
        self.used(value);
        let shared = self.kinds.get(pointer) == Kind::Shared;
        let text = if shared {
            self.expression(value).rust
        } else {
            self.lanes(value).rust
        };
        self.flush(|root| *root == from);
        // An element of the stack of waiting rays.
        if let Expression::Access { base, index } = self.function.expressions[pointer] {
            let base = self.expression(base).rust;
            let index = self.lanes(index).rust;
            self.line(&format!("scene.put(&mut {base}, on, {index}, {text});"));
            return;
        }
        let place = match self.function.expressions[pointer] {
            Expression::FunctionArgument(_) => format!("*{}", self.expression(pointer).rust),
            _ => self.expression(pointer).rust,
        };
        let masked = match &from {
            Expression::LocalVariable(local) => {
                !shared && self.homes.get(local) != Some(&self.region)
            }
            Expression::FunctionArgument(_) => {
                !self.shader.told.unmasked.contains(&name(self.function))
            }
            _ => true,
        };
        if let Expression::LocalVariable(local) = self.function.expressions[pointer]
            && self.declared.insert(local)
        {
            let ty = self.function.local_variables[local].ty;
            let ty = match type_of_shared(&self.shader.module.types[ty].inner) {
                number @ ("u32" | "f32" | "f64") if shared => format!(": {number}"),
                _ => String::new(),
            };
            self.line(&format!("let mut {place}{ty} = {text};"));
        } else if masked {
            let place = place.trim_start_matches('*');
            self.line(&format!("{place}.set(on, {text});"));
        } else {
            self.line(&format!("{place} = {text};"));
        }
    }
}

/// Whether a block leaves what stands around it by `break`: not a loop of its own.
fn breaks(block: &[Statement]) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Break => true,
        Statement::Loop { .. } => false,
        statement => inner_blocks(statement).into_iter().any(breaks),
    })
}

/// What an expression is made of.
fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    match expression {
        Expression::Compose { components, .. } => components.clone(),
        Expression::Access { base, index } => vec![*base, *index],
        Expression::AccessIndex { base, .. } => vec![*base],
        Expression::Splat { value, .. } => vec![*value],
        Expression::Swizzle { vector, .. } => vec![*vector],
        Expression::Load { pointer } => vec![*pointer],
        Expression::Unary { expr, .. } | Expression::As { expr, .. } => vec![*expr],
        Expression::Binary { left, right, .. } => vec![*left, *right],
        Expression::Select {
            condition,
            accept,
            reject,
        } => vec![*condition, *accept, *reject],
        Expression::Relational { argument, .. } => vec![*argument],
        Expression::Math {
            arg, arg1, arg2, ..
        } => [Some(*arg), *arg1, *arg2].into_iter().flatten().collect(),
        _ => Vec::new(),
    }
}
