//! Reads of uniform blocks and push constants at known places, each once, where their function begins.
//!
//! They say the same wherever they are read. Under a branch, in a loop or after an early return lavapipe reads them lane by
//! lane, 26 instructions a number in place of one that all lanes share; glslang reads where the source does. A device with
//! scalar registers puts them where it likes.

use std::collections::{BTreeMap, BTreeSet};

/// Instructions (SPIR-V, 3.49), storage classes (3.7).
const CONSTANT: u32 = 43;
const FUNCTION: u32 = 54;
const FUNCTION_END: u32 = 56;
const VARIABLE: u32 = 59;
const LOAD: u32 = 61;
const ACCESS_CHAIN: u32 = 65;
const COPY_OBJECT: u32 = 83;
const LABEL: u32 = 248;
const UNIFORM: u32 = 2;
const PUSH_CONSTANT: u32 = 9;

/// Words before the first instruction, and the one of them that all ids are below.
const HEADER: usize = 5;
const BOUND: usize = 3;

/// Instructions of a module, each with its first word, which says which it is and how long.
fn instructions(module: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut rest = &module[HEADER..];
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let (own, after) = rest.split_at((first >> 16) as usize);
        rest = after;
        Some((first & 0xffff, own))
    })
}

fn instruction(op: u32, operands: &[u32]) -> impl Iterator<Item = u32> {
    let first = (operands.len() as u32 + 1) << 16 | op;
    std::iter::once(first).chain(operands.iter().copied())
}

/// What of a module makes a place known.
#[derive(Default)]
struct Known {
    constants: BTreeSet<u32>,
    blocks: BTreeSet<u32>,
}

impl Known {
    fn add(&mut self, op: u32, own: &[u32]) {
        match op {
            CONSTANT => drop(self.constants.insert(own[2])),
            VARIABLE if matches!(own[3], UNIFORM | PUSH_CONSTANT) => {
                self.blocks.insert(own[2]);
            }
            _ => {}
        }
    }

    fn is_place(&self, op: u32, own: &[u32]) -> bool {
        op == ACCESS_CHAIN
            && self.blocks.contains(&own[3])
            && own[4..].iter().all(|index| self.constants.contains(index))
    }
}

/// A function as far as it is read.
#[derive(Default)]
struct Function {
    /// Up to the first block's variables, and from there on.
    head: Vec<u32>,
    body: Vec<u32>,
    begun: bool,
    /// The reads that stand between.
    reads: Vec<u32>,
    /// Of a pointer its type, block and indices.
    places: BTreeMap<u32, Vec<u32>>,
    /// What a place holds.
    values: BTreeMap<Vec<u32>, u32>,
}

impl Function {
    fn add(&mut self, known: &Known, bound: &mut u32, (op, own): (u32, &[u32])) {
        if known.is_place(op, own) {
            self.places.insert(own[2], [&own[1..2], &own[3..]].concat());
        }
        // Longer ones ask for more, as to be volatile.
        let place = if op == LOAD && own.len() == 4 { self.places.get(&own[3]) } else { None };
        if let Some(place) = place {
            let value = *self.values.entry(place.clone()).or_insert_with(|| {
                let (pointer, value) = (*bound, *bound + 1);
                *bound += 2;
                let chain = [&place[..1], &[pointer], &place[1..]].concat();
                self.reads.extend(instruction(ACCESS_CHAIN, &chain));
                self.reads.extend(instruction(LOAD, &[own[1], value, pointer]));
                value
            });
            self.body.extend(instruction(COPY_OBJECT, &[own[1], own[2], value]));
            return;
        }
        let head = !self.begun || (op == VARIABLE && self.body.is_empty());
        self.begun |= op == LABEL;
        if head { &mut self.head } else { &mut self.body }.extend(own);
    }
}

/// The module with such reads where their functions begin.
pub fn hoisted(module: &[u32]) -> Vec<u32> {
    let mut out = module[..HEADER].to_vec();
    let mut bound = out[BOUND];
    let mut known = Known::default();
    let mut function = None;
    for (op, own) in instructions(module) {
        if op == FUNCTION {
            function = Some(Function::default());
        }
        let Some(open) = &mut function else {
            known.add(op, own);
            out.extend(own);
            continue;
        };
        open.add(&known, &mut bound, (op, own));
        if op == FUNCTION_END {
            out.extend([&open.head[..], &open.reads, &open.body].concat());
            function = None;
        }
    }
    out[BOUND] = bound;
    out
}

/// How many such reads there are, in all, and of those how many stand in another block than their function's first.
pub fn counted(module: &[u32]) -> (usize, usize) {
    let mut known = Known::default();
    let (mut all, mut late, mut blocks) = (0, 0, 0);
    let mut places = BTreeSet::new();
    for (op, own) in instructions(module) {
        known.add(op, own);
        blocks = if op == FUNCTION { 0 } else { blocks + usize::from(op == LABEL) };
        if known.is_place(op, own) {
            places.insert(own[2]);
        }
        if op == LOAD && own.len() == 4 && places.contains(&own[3]) {
            all += 1;
            late += usize::from(blocks > 1);
        }
    }
    (all, late)
}
