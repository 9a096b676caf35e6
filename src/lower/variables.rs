//! Where a function's variables belong to, and how they are declared.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Expression, Handle, LocalVariable, Statement};

use super::module::{each_statement, inner_blocks, root};
use super::signature::shared as type_of_shared;
use super::statement::Writer;

/// Parts of a function between divergences: each but the first has one around it.
#[derive(Default)]
pub(super) struct Regions {
    pub(super) around: Vec<usize>,
    /// By the address of the block.
    pub(super) of: BTreeMap<usize, usize>,
}

impl Regions {
    pub(super) fn common(&self, mut a: usize, mut b: usize) -> usize {
        while a != b {
            if a > b {
                a = self.around[a];
            } else {
                b = self.around[b];
            }
        }
        a
    }
}

/// What is noted on the way through a function's blocks.
#[derive(Default)]
struct Visits {
    /// The block that opened the region, and whether a loop is around.
    opened: usize,
    in_loop: bool,
    /// The regions in loops.
    in_loops: BTreeSet<usize>,
    /// The variables seen so far; and those that were stored into as a whole first, with the region where every lane
    /// that comes into it does so.
    seen: BTreeSet<Handle<LocalVariable>>,
    fresh: BTreeMap<Handle<LocalVariable>, usize>,
}

pub(super) fn address(block: &[Statement]) -> usize {
    block.as_ptr() as usize
}

impl<'a> Writer<'a> {
    /// Numbers the regions, and finds the one of each variable.
    pub(super) fn find_homes(&mut self) {
        self.regions.around.push(0);
        let mut visits = Visits::default();
        self.find_regions(&self.function.body, 0, &mut visits);
        // A variable that keeps its value from one round of a loop to the next is looked at again by lanes that are off
        // in between: it belongs to the whole function, so that whatever is stored in the loop is masked.
        for (local, home) in &mut self.homes {
            if visits.in_loops.contains(home) && visits.fresh.get(local) != Some(home) {
                *home = 0;
            }
        }
    }

    fn find_regions(&mut self, block: &'a [Statement], region: usize, visits: &mut Visits) {
        self.regions.of.insert(address(block), region);
        for statement in block {
            let mut touched = Vec::new();
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        if let Expression::Load { pointer } = self.function.expressions[expression]
                        {
                            touched.push(pointer);
                        }
                    }
                }
                Statement::Store { pointer, .. } => touched.push(*pointer),
                Statement::Call { arguments, .. } => touched.extend(arguments),
                _ => {}
            }
            for pointer in touched {
                if let Expression::LocalVariable(local) = root(self.function, pointer) {
                    let whole = matches!(statement, Statement::Store { .. })
                        && matches!(
                            self.function.expressions[pointer],
                            Expression::LocalVariable(_)
                        );
                    if visits.seen.insert(*local) && whole && visits.opened == address(block) {
                        visits.fresh.insert(*local, region);
                    }
                    let home = self.homes.get(local).copied().unwrap_or(region);
                    let home = self.regions.common(home, region);
                    self.homes.insert(*local, home);
                }
            }
            let uniform = self.kinds.is_uniform(statement);
            let before = (visits.opened, visits.in_loop);
            visits.in_loop |= matches!(statement, Statement::Loop { .. });
            for inner in inner_blocks(statement) {
                let mut inside = region;
                if !uniform {
                    self.regions.around.push(region);
                    inside = self.regions.around.len() - 1;
                    visits.opened = address(inner);
                    if visits.in_loop {
                        visits.in_loops.insert(inside);
                    }
                }
                if matches!(statement, Statement::Block(_)) && visits.opened == address(block) {
                    visits.opened = address(inner);
                }
                self.find_regions(inner, inside, visits);
            }
            (visits.opened, visits.in_loop) = before;
        }
    }

    /// Declares the variables that are not first stored into as a whole where they belong to.
    pub(super) fn declare(&mut self) {
        let mut whole = BTreeSet::new();
        let mut seen = BTreeSet::new();
        for statement in &self.function.body {
            let mut touches = Vec::new();
            let mut note = |statement: &Statement| match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        if let Expression::Load { pointer } = self.function.expressions[expression]
                        {
                            touches.push(pointer);
                        }
                    }
                }
                Statement::Store { pointer, .. } => touches.push(*pointer),
                Statement::Call { arguments, .. } => touches.extend(arguments),
                _ => {}
            };
            each_statement(std::slice::from_ref(statement), &mut note);
            let stored = match statement {
                Statement::Store { pointer, .. } => match self.function.expressions[*pointer] {
                    Expression::LocalVariable(local) => Some(local),
                    _ => None,
                },
                _ => None,
            };
            for pointer in touches {
                if let Expression::LocalVariable(local) = root(self.function, pointer)
                    && seen.insert(*local)
                    && stored == Some(*local)
                {
                    whole.insert(*local);
                }
            }
        }
        for (handle, local) in self.function.local_variables.iter() {
            let unused = !seen.contains(&handle);
            if whole.contains(&handle) && local.init.is_none() || unused {
                continue;
            }
            self.declared.insert(handle);
            let name = self.local(handle);
            let shared = self.kinds.shared.contains(&handle);
            let value = match local.init {
                Some(init) if shared => self.expression(init).rust,
                Some(init) => self.lanes(init).rust,
                None if shared => match self.shader.module.types[local.ty].inner.scalar_kind() {
                    Some(naga::ScalarKind::Float) => "0.0".into(),
                    Some(naga::ScalarKind::Bool) => "false".into(),
                    _ => "0".into(),
                },
                None => {
                    let ty = self.shader.rust_type(local.ty);
                    format!("<{ty}>::zero(scene.simd)")
                }
            };
            let ty = match type_of_shared(&self.shader.module.types[local.ty].inner) {
                "bool" => String::new(),
                number if shared && local.init.is_some() => format!(": {number}"),
                _ => String::new(),
            };
            self.line(&format!("let mut {name}{ty} = {value};"));
        }
    }
}
