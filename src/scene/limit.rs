//! What the values of an attribute must keep, and how that is said: a column of the `table`.

/// The largest number of columns or rows of a picture.
pub const MAX_PIXELDIM: u32 = 1_000_000;

/// What the values of an attribute must keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Limit {
    /// Finite numbers all.
    None,
    /// Each > 0.
    Positive,
    /// Each ≥ 0.
    NotNegative,
    /// Each 0 to 1.
    Share,
    /// Each 1 to [`MAX_PIXELDIM`].
    Pixels,
    /// Each 0 to below so many.
    Below(u32),
    /// 0 < angle ≤ 180.
    HalfAngle,
    /// Not (0, 0, 0).
    NotZero,
    /// Its z > 0.
    InFront,
    /// Of all but the last one is not 0.
    NotConstant,
}

impl Limit {
    /// Which of these values break the limit: for a vector as a whole, all of them.
    pub(super) fn broken(self, values: &[f64]) -> Vec<usize> {
        let all = |broken: bool| {
            if broken {
                (0..values.len()).collect()
            } else {
                Vec::new()
            }
        };
        let each = |kept: fn(f64) -> bool| {
            (0..values.len())
                .filter(|index| !kept(values[*index]))
                .collect()
        };
        match self {
            Limit::None => Vec::new(),
            Limit::Positive => each(|value| value > 0.0),
            Limit::NotNegative => each(|value| value >= 0.0),
            Limit::Share => each(|value| (0.0..=1.0).contains(&value)),
            Limit::Pixels => each(|value| (1.0..=f64::from(MAX_PIXELDIM)).contains(&value)),
            Limit::Below(count) => all(!(0.0..f64::from(count)).contains(&values[0])),
            Limit::HalfAngle => each(|value| value > 0.0 && value <= 180.0),
            Limit::NotZero => all(values.iter().all(|value| *value == 0.0)),
            Limit::NotConstant => all(values
                .split_last()
                .is_none_or(|(_, rest)| rest.iter().all(|value| *value == 0.0))),
            Limit::InFront => {
                if values[2] > 0.0 {
                    Vec::new()
                } else {
                    vec![2]
                }
            }
        }
    }

    /// The limit, after "`attribute` must be ".
    pub(super) fn wording(self) -> String {
        match self {
            Limit::None => String::from("a finite number"),
            Limit::Positive => String::from("greater than 0"),
            Limit::NotNegative => String::from("0 or more"),
            Limit::Share => String::from("0 to 1"),
            Limit::Pixels => String::from("1 to 1,000,000"),
            Limit::Below(1) => String::from("0, the only one there is"),
            Limit::Below(2) => String::from("0 or 1"),
            Limit::Below(count) => format!("0 to {}", count.saturating_sub(1)),
            Limit::HalfAngle => String::from("greater than 0 and at most 180 (degrees)"),
            Limit::NotZero => String::from("a direction, not 0 0 0"),
            Limit::InFront => String::from("in front of the screen: its z greater than 0"),
            Limit::NotConstant => {
                String::from("an equation in x, y or z: of the first nine one is not 0")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_limit_takes_what_is_not_a_number() {
        let limits = [
            Limit::Positive,
            Limit::NotNegative,
            Limit::Share,
            Limit::Pixels,
            Limit::Below(3),
        ];
        for limit in limits {
            assert_eq!(limit.broken(&[f64::NAN]), [0], "{limit:?}");
        }
        assert_eq!(
            Limit::Pixels.wording().replace(',', ""),
            format!("1 to {MAX_PIXELDIM}")
        );
    }
}
