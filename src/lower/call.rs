//! Calls as Rust.

use naga::{Expression, Function, Handle};

use super::kinds::Kind;
use super::module::name;
use super::statement::Writer;

impl Writer<'_> {
    /// A call, whose result has a name from then on.
    pub(super) fn call(
        &mut self,
        function: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Option<Handle<Expression>>,
    ) {
        let called = &self.shader.module.functions[function];
        let own = name(called);
        if self.shader.told.unmasked.contains(&own) {
            panic!(
                "{}: {own} stores for all lanes, and is called by hand alone",
                name(self.function)
            );
        }
        if self.shader.told.identity.contains(&own)
            && let (Some(result), [argument]) = (result, arguments)
        {
            self.used(*argument);
            let text = self.lanes(*argument).rust;
            let named = self.function.named_expressions.get(&result).cloned();
            let name = self.fresh(&named.unwrap_or_else(|| "v".into()));
            self.line(&format!("let {name} = {text};"));
            self.baked.insert(result, name);
            return;
        }
        let mut texts = vec!["scene".to_string()];
        if self.shader.state.contains(own) {
            texts.push("state".into());
        }
        if self.shader.on.contains(own) {
            texts.push("on".into());
        }
        for (argument, formal) in arguments.iter().zip(&called.arguments) {
            let formal = formal.name.as_deref().unwrap_or_default();
            let uniform = self
                .shader
                .told
                .uniform
                .iter()
                .any(|(f, a)| *f == own && *a == formal);
            let kind = self.kinds.get(*argument);
            self.used(*argument);
            let text = self.expression(*argument).rust;
            texts.push(match (kind, uniform) {
                (Kind::Place, _) => match self.function.expressions[*argument] {
                    Expression::FunctionArgument(_) => text,
                    _ => format!("&mut {text}"),
                },
                (Kind::Record, true) if text.contains('[') => format!("&{text}"),
                (Kind::Record | Kind::Shared, true) | (Kind::Gathered, false) => text,
                (Kind::Record, false) => format!("scene.same(&{text})"),
                (Kind::Lanes | Kind::Shared | Kind::Array, false) => self.lanes(*argument).rust,
                _ => self.fail("an argument that differs from lane to lane", *argument),
            });
        }
        self.flush(|_| true);
        let module = if self.shader.is_outside(own) {
            "by_hand::"
        } else {
            ""
        };
        let call = format!("{module}{own}({})", texts.join(", "));
        match result {
            Some(result) => {
                let named = self.function.named_expressions.get(&result).cloned();
                let wish = named.unwrap_or_else(|| own.rsplit('_').next().unwrap_or("v").into());
                let name = self.fresh(&wish);
                self.line(&format!("let {name} = {call};"));
                self.baked.insert(result, name);
            }
            None => self.line(&format!("{call};")),
        }
    }
}
