//! Small texts whose lowering shows a rule.

use expect_test::expect;

use super::module::Told;
use super::texts::lowered;

/// The function `asked`, lowered.
fn asked(wgsl: &str) -> String {
    let told = Told {
        roots: &["asked"],
        by_hand: &[],
        uniform: &[],
        apart: &[],
        unmasked: &[],
        identity: &[],
        objects: "objects",
        records: &[],
    };
    let text = lowered("A test", wgsl, told);
    text[text.find("#[inline(always)]\npub(super) fn asked").unwrap()..].into()
}

#[test]
fn what_is_kept_from_round_to_round_is_kept_for_lanes_that_are_off() {
    // `all` is looked at in the inner loop alone, but again in the next round of the outer one; `fresh` is not.
    let text = asked(
        "fn asked(rounds: u32) -> u32 {
            var all = 0u;
            var i = rounds;
            loop {
                if i == 0u {
                    break;
                }
                var k = i;
                loop {
                    if k == 0u || all > 9u {
                        break;
                    }
                    var fresh = k;
                    fresh += all;
                    all += fresh;
                    k -= 1u;
                }
                i -= 1u;
            }
            return i;
        }",
    );
    let stores: String = text
        .lines()
        .filter(|line| line.trim().starts_with("all") || line.trim().starts_with("fresh"))
        .map(|line| format!("{}\n", line.trim()))
        .collect();
    expect![[r#"
        fresh = k;
        fresh = fresh + all;
        all.set(on, all + fresh);
    "#]]
    .assert_eq(&stores);
}
