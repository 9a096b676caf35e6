//! Where lanes go different ways: branches, loops, and leaving them early.

use naga::{Expression, Handle, Statement};

use super::kinds::{exits, returns};
use super::module::{inner_blocks, name};
use super::statement::Writer;

impl<'a> Writer<'a> {
    pub(super) fn branch(
        &mut self,
        condition: Handle<Expression>,
        accept: &'a [Statement],
        reject: &'a [Statement],
    ) {
        self.used(condition);
        let text = self.expression(condition).rust;
        self.flush(|_| true);
        if self.kinds.is_shared(condition) {
            // What the driver's limit on loops asks has no meaning here, where nobody counts rounds.
            if text.contains("STEPS_LIMIT") {
                if text != "0 > constants::STEPS_LIMIT" || !reject.is_empty() {
                    panic!(
                        "{}: more than the limit on steps in `{text}`",
                        name(self.function)
                    );
                }
                return;
            }
            self.line(&format!("if {text} {{"));
            self.nested(accept);
            if !reject.is_empty() {
                self.line("} else {");
                self.nested(reject);
            }
            self.line("}");
        } else {
            let text = if reject.is_empty() {
                text
            } else {
                let holds = self.fresh("holds");
                self.line(&format!("let {holds} = {text};"));
                holds
            };
            let operand = |text: &str| {
                if text.contains(' ') && !text.ends_with(')')
                    || text.contains(" & ")
                    || text.contains(" | ")
                {
                    format!("({text})")
                } else {
                    text.to_string()
                }
            };
            self.line(&format!("let here = on & {};", operand(&text)));
            self.masked(accept);
            if !reject.is_empty() {
                self.line(&format!("let here = on & !{};", operand(&text)));
                self.masked(reject);
            }
        }
        if exits(accept) || exits(reject) {
            self.after_exits();
        }
    }

    pub(super) fn nested(&mut self, block: &'a [Statement]) {
        self.depth += 1;
        let baked = self.baked.clone();
        self.block(block, false, true);
        self.baked = baked;
        self.depth -= 1;
    }

    /// A block for the lanes that are `here`.
    pub(super) fn masked(&mut self, block: &'a [Statement]) {
        if block.is_empty() {
            return;
        }
        self.line("if here.any() {");
        self.depth += 1;
        let inner = block.iter().any(|s| inner_blocks(s).into_iter().any(exits));
        self.line(if inner {
            "let mut on = here;"
        } else {
            "let on = here;"
        });
        self.depth -= 1;
        self.nested(block);
        self.line("}");
    }

    /// Lanes that left are on no more.
    pub(super) fn after_exits(&mut self) {
        match self.loops.last() {
            Some(true) if !self.loops.contains(&false) && !self.leaves_early() => {}
            Some(false) => {
                let label = self.loops.len();
                self.line(&format!("on = on & !gone_{label};"));
                if self.depth == 1 + 2 * label {
                    self.line(&format!("if !on.any() {{ break 'round_{label}; }}"));
                }
            }
            _ => {
                let gone = self.gone();
                self.line(&format!("on = on & !{gone};"));
                if self.depth == 1 {
                    let result = self.function.result.as_ref().map_or("", |_| " result");
                    self.line(&format!("if !on.any() {{ return{result}; }}"));
                }
            }
        }
    }

    pub(super) fn repeat(
        &mut self,
        statement: &Statement,
        body: &'a [Statement],
        continuing: &'a [Statement],
        break_if: Option<Handle<Expression>>,
    ) {
        self.flush(|_| true);
        if break_if.is_some() {
            panic!("{}: break if", name(self.function));
        }
        let uniform = self.kinds.is_uniform(statement);
        self.loops.push(uniform);
        if uniform {
            self.line("loop {");
            self.nested(body);
            self.nested(continuing);
            self.line("}");
            self.loops.pop();
        } else {
            let label = self.loops.len();
            self.line(&format!("let mut looping_{label} = on;"));
            self.line(&format!("while looping_{label}.any() {{"));
            self.depth += 1;
            self.line(&format!("let mut on = looping_{label};"));
            self.line(&format!("let mut gone_{label} = scene.mask(false);"));
            self.line(&format!("'round_{label}: {{"));
            self.nested(body);
            self.line("}");
            self.depth -= 1;
            if !continuing.is_empty() {
                self.depth += 1;
                self.line(&format!("let on = looping_{label};"));
                self.depth -= 1;
                self.nested(continuing);
            }
            self.line("}");
            self.loops.pop();
            if returns(body) {
                let gone = self.gone();
                self.line(&format!("on = on & !{gone};"));
            }
        }
    }

    pub(super) fn leave(&mut self, value: Option<Handle<Expression>>, last: bool, early: bool) {
        let text = value.map(|value| {
            self.used(value);
            self.lanes(value).rust
        });
        self.flush(|_| true);
        if last {
            match (text, early) {
                (Some(text), true) => {
                    self.line(&format!("result.set(on, {text});"));
                    self.line("result");
                }
                (Some(text), false) => self.line(&text),
                (None, _) => {}
            }
            return;
        }
        if let Some(text) = text {
            self.line(&format!("result.set(on, {text});"));
        }
        self.line("gone = gone | on;");
        for level in 1..=self.loops.len() {
            if !self.loops[level - 1] {
                self.line(&format!("looping_{level} = looping_{level} & !on;"));
                self.line(&format!("gone_{level} = gone_{level} | on;"));
            }
        }
    }

    /// What has the lanes that left the innermost loop's round, or the function.
    pub(super) fn gone(&self) -> String {
        match self.loops.iter().rposition(|uniform| !uniform) {
            Some(level) => format!("gone_{}", level + 1),
            None => "gone".into(),
        }
    }
}
