//! Operators, functions of WGSL and conversions as Rust.

use naga::{BinaryOperator, Expression, Handle, MathFunction, Scalar, ScalarKind, TypeInner};

use super::expression::{ATOM, CAST, Text, atom};
use super::statement::Writer;

impl Writer<'_> {
    pub(super) fn binary(
        &self,
        shared: bool,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Text {
        let (sign, method, binding) = match op {
            BinaryOperator::Add => ("+", "", 11),
            BinaryOperator::Subtract => ("-", "", 11),
            BinaryOperator::Multiply => ("*", "", 12),
            BinaryOperator::Divide => ("/", "", 12),
            BinaryOperator::Modulo => ("%", "", 12),
            BinaryOperator::And | BinaryOperator::LogicalAnd => ("&", "", 9),
            BinaryOperator::ExclusiveOr => ("^", "", 8),
            BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr => ("|", "", 7),
            BinaryOperator::ShiftLeft => ("<<", "", 10),
            BinaryOperator::ShiftRight => (">>", "", 10),
            BinaryOperator::Equal => ("==", "eq", 5),
            BinaryOperator::NotEqual => ("!=", "ne", 5),
            BinaryOperator::Less => ("<", "lt", 5),
            BinaryOperator::LessEqual => ("<=", "le", 5),
            BinaryOperator::Greater => (">", "gt", 5),
            BinaryOperator::GreaterEqual => (">=", "ge", 5),
        };
        if shared {
            let [a, b] = [left, right].map(|e| self.expression(e));
            return Text {
                rust: format!("{} {sign} {}", a.within(binding), b.within(binding + 1)),
                binding,
            };
        }
        if !method.is_empty() {
            let a = self.lanes(left).within(ATOM);
            let b = self.lanes(right).rust;
            return match self.inner(left) {
                TypeInner::Vector { .. } => atom(format!("{a}.zip({b}, |a, b| a.{method}(b))")),
                _ => atom(format!("{a}.{method}({b})")),
            };
        }
        // Numbers meet lanes in operators; truths do not.
        let truths = self.inner(left).scalar_kind() == Some(ScalarKind::Bool);
        let operand = |e: Handle<Expression>| {
            if self.kinds.is_shared(e) && !truths {
                self.expression(e)
            } else {
                self.lanes(e)
            }
        };
        let (a, b) = (operand(left), operand(right));
        Text {
            rust: format!("{} {sign} {}", a.within(binding), b.within(binding + 1)),
            binding,
        }
    }

    pub(super) fn math(
        &self,
        expression: Handle<Expression>,
        fun: MathFunction,
        operands: &[Handle<Expression>],
        shared: bool,
    ) -> Text {
        let method = match fun {
            MathFunction::Abs => "abs",
            MathFunction::Min => "min",
            MathFunction::Max => "max",
            MathFunction::Clamp => "clamp",
            MathFunction::Floor => "floor",
            MathFunction::Round => "round",
            MathFunction::Sqrt => "sqrt",
            MathFunction::InverseSqrt => "inverse_sqrt",
            MathFunction::Dot => "dot",
            MathFunction::Cross => "cross",
            _ => self.fail("a function", expression),
        };
        if shared {
            if matches!(fun, MathFunction::Round | MathFunction::InverseSqrt) {
                self.fail("a function of numbers that lanes share", expression);
            }
            let first = self.expression(operands[0]).within(ATOM);
            let rest: Vec<_> = operands[1..]
                .iter()
                .map(|e| self.expression(*e).rust)
                .collect();
            return atom(format!("{first}.{method}({})", rest.join(", ")));
        }
        let first = self.lanes(operands[0]).within(ATOM);
        let rest: Vec<_> = operands[1..].iter().map(|e| self.lanes(*e).rust).collect();
        let vector = matches!(self.inner(operands[0]), TypeInner::Vector { .. });
        if !vector || ["dot", "cross"].contains(&method) {
            return atom(format!("{first}.{method}({})", rest.join(", ")));
        }
        match &rest[..] {
            [] => atom(format!("{first}.map(|v| v.{method}())")),
            [other] => atom(format!("{first}.zip({other}, |a, b| a.{method}(b))")),
            [low, high] => atom(format!(
                "{first}.zip({low}, |v, low| v.max(low)).zip({high}, |v, high| v.min(high))"
            )),
            _ => self.fail("a function", expression),
        }
    }

    pub(super) fn cast(
        &self,
        expression: Handle<Expression>,
        of: Handle<Expression>,
        (kind, width): (ScalarKind, Option<u8>),
        shared: bool,
    ) -> Text {
        let converts = width.is_some();
        let from = self.inner(of).scalar();
        let to = match (kind, width) {
            (ScalarKind::Float, Some(8)) => "f64",
            (ScalarKind::Float, _) => "f32",
            (ScalarKind::Uint, _) => "u32",
            (ScalarKind::Sint, _) => "i32",
            _ => self.fail("a conversion", expression),
        };
        let same =
            |from: Scalar| from.kind == kind && width.is_none_or(|width| width == from.width);
        if from.is_some_and(same) {
            return self.expression(of);
        }
        let from = from.map(|from| from.kind);
        if shared {
            if !converts {
                self.fail("bits that lanes share", expression);
            }
            return Text {
                rust: format!("{} as {to}", self.expression(of).within(CAST)),
                binding: CAST,
            };
        }
        let method = match (converts, from, kind) {
            (false, Some(ScalarKind::Float), ScalarKind::Uint) => "bits".into(),
            (false, Some(ScalarKind::Float), ScalarKind::Sint) => "signed_bits".into(),
            (false, _, ScalarKind::Float) => "float".into(),
            _ => format!("as_{to}"),
        };
        let text = self.lanes(of).within(ATOM);
        match self.inner(of) {
            TypeInner::Vector { .. } => atom(format!("{text}.map(|v| v.{method}())")),
            _ => atom(format!("{text}.{method}()")),
        }
    }
}
