//! Specializes SPIR-V before the driver sees it: constants get their values, and code that these rule out is removed.
//!
//! A driver does this itself, but only after it has translated the whole module. The large shaders have many variants,
//! each of which uses a third to half of the code. Without the rest, pipelines are created sooner.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;

// Opcodes (SPIR-V specification, section 3.52).
const NAME: u32 = 5;
const TYPE_VOID: u32 = 19;
const TYPE_BOOL: u32 = 20;
const TYPE_INT: u32 = 21;
const TYPE_FORWARD_POINTER: u32 = 39;
const CONSTANT_TRUE: u32 = 41;
const CONSTANT_FALSE: u32 = 42;
const CONSTANT: u32 = 43;
const CONSTANT_COMPOSITE: u32 = 44;
const SPEC_CONSTANT_TRUE: u32 = 48;
const SPEC_CONSTANT_FALSE: u32 = 49;
const SPEC_CONSTANT: u32 = 50;
const SPEC_CONSTANT_COMPOSITE: u32 = 51;
const SPEC_CONSTANT_OP: u32 = 52;
const FUNCTION: u32 = 54;
const FUNCTION_END: u32 = 56;
const DECORATE: u32 = 71;
const COPY_OBJECT: u32 = 83;
const LOGICAL_EQUAL: u32 = 164;
const LOGICAL_NOT_EQUAL: u32 = 165;
const LOGICAL_OR: u32 = 166;
const LOGICAL_AND: u32 = 167;
const LOGICAL_NOT: u32 = 168;
const SELECT: u32 = 169;
const EQUAL: u32 = 170;
const NOT_EQUAL: u32 = 171;
const U_GREATER: u32 = 172;
const S_GREATER: u32 = 173;
const U_GREATER_EQUAL: u32 = 174;
const S_GREATER_EQUAL: u32 = 175;
const U_LESS: u32 = 176;
const S_LESS: u32 = 177;
const U_LESS_EQUAL: u32 = 178;
const S_LESS_EQUAL: u32 = 179;
const PHI: u32 = 245;
const LOOP_MERGE: u32 = 246;
const SELECTION_MERGE: u32 = 247;
const LABEL: u32 = 248;
const BRANCH: u32 = 249;
const BRANCH_CONDITIONAL: u32 = 250;
const SWITCH: u32 = 251;
const UNREACHABLE: u32 = 255;
/// The decoration of a specialization constant.
const SPEC_ID: u32 = 1;
/// Words of a module's header.
const HEADER: usize = 5;

/// What is known about the value of an id, which is a boolean (0 or 1) or a 32-bit integer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Value {
    /// Nothing has been computed yet.
    Open,
    Known(u32),
    Varying,
}

use Value::{Known, Open, Varying};

/// The instructions of a part of the code: the place of each, its opcode and its words.
fn instructions(
    code: &[u32],
    mut range: Range<usize>,
) -> impl Iterator<Item = (usize, u32, &[u32])> {
    std::iter::from_fn(move || {
        let at = range.start;
        let word = code.get(..range.end)?.get(at)?;
        range.start += (word >> 16).max(1) as usize;
        Some((at, word & 0xffff, code.get(at..range.start)?))
    })
}

fn push(out: &mut Vec<u32>, opcode: u32, operands: &[u32]) {
    out.push((operands.len() as u32 + 1) << 16 | opcode);
    out.extend(operands);
}

/// Folds an operation, as far as its operands are known.
fn result(opcode: u32, of: &[Value]) -> Value {
    let both = |f: fn(u32, u32) -> bool| match *of {
        [Known(a), Known(b)] => Known(f(a, b).into()),
        [Open, _] | [_, Open] => Open,
        _ => Varying,
    };
    match (opcode, of) {
        (LOGICAL_AND, [Known(0), _] | [_, Known(0)]) => Known(0),
        (LOGICAL_OR, [Known(1), _] | [_, Known(1)]) => Known(1),
        (LOGICAL_AND, _) => both(|a, b| a & b != 0),
        (LOGICAL_OR, _) => both(|a, b| a | b != 0),
        (LOGICAL_NOT, [Known(a)]) => Known(1 - a),
        (LOGICAL_NOT | COPY_OBJECT, [a]) => *a,
        (SELECT, [Known(0), _, a] | [Known(_), a, _]) => *a,
        (SELECT, [a, ..]) => *a,
        (LOGICAL_EQUAL | EQUAL, _) => both(|a, b| a == b),
        (LOGICAL_NOT_EQUAL | NOT_EQUAL, _) => both(|a, b| a != b),
        (U_GREATER, _) => both(|a, b| a > b),
        (U_GREATER_EQUAL, _) => both(|a, b| a >= b),
        (U_LESS, _) => both(|a, b| a < b),
        (U_LESS_EQUAL, _) => both(|a, b| a <= b),
        (S_GREATER, _) => both(|a, b| a as i32 > b as i32),
        (S_GREATER_EQUAL, _) => both(|a, b| a as i32 >= b as i32),
        (S_LESS, _) => both(|a, b| (a as i32) < b as i32),
        (S_LESS_EQUAL, _) => both(|a, b| a as i32 <= b as i32),
        _ => Varying,
    }
}

/// A module, and what is known about the values of its ids.
struct Module<'a> {
    code: &'a [u32],
    /// By id. Ids whose values are not followed are [`Varying`].
    values: Vec<Value>,
    booleans: HashSet<u32>,
    integers: HashSet<u32>,
    types: HashSet<u32>,
    /// Results of code that was removed.
    removed: HashSet<u32>,
}

/// The module with the given values of its specialization constants (id, value); others have their defaults.
///
/// `code` must be a valid module. The result computes the same and has no specialization constants.
pub fn specialized(code: &[u32], constants: &[(u32, u32)]) -> Vec<u32> {
    let bound = code.get(3).copied().unwrap_or(0) as usize;
    let mut module = Module {
        code,
        values: vec![Varying; bound],
        booleans: HashSet::new(),
        integers: HashSet::new(),
        types: HashSet::new(),
        removed: HashSet::new(),
    };
    let mut globals = Vec::new();
    let mut first = module.freeze(constants, &mut globals);
    let mut functions = Vec::new();
    for (at, opcode, words) in instructions(code, first..code.len()) {
        if opcode == FUNCTION_END {
            let end = at + words.len();
            match Function::new(code, first..end) {
                Some(function) => function.prune(&mut module, &mut functions),
                None => functions.extend(&code[first..end]),
            }
            first = end;
        }
    }
    // Names and decorations of removed ids are removed too.
    let mut out = code[..HEADER].to_vec();
    for (_, opcode, words) in instructions(&globals, 0..globals.len()) {
        if !(matches!(opcode, DECORATE | NAME) && module.removed.contains(&words[1])) {
            out.extend(words);
        }
    }
    out.extend(functions);
    out
}

impl Module<'_> {
    /// Writes all that precedes the functions; returns where these begin.
    fn freeze(&mut self, constants: &[(u32, u32)], out: &mut Vec<u32>) -> usize {
        let given: HashMap<u32, u32> = constants.iter().copied().collect();
        let mut ids = HashMap::new();
        for (at, opcode, words) in instructions(self.code, HEADER..self.code.len()) {
            if (TYPE_VOID..=TYPE_FORWARD_POINTER).contains(&opcode) {
                self.types.insert(words[1]);
            }
            let given = |id: u32| ids.get(&id).and_then(|spec| given.get(spec)).copied();
            match (opcode, words) {
                (FUNCTION, _) => return at,
                (DECORATE, &[_, id, SPEC_ID, spec]) => {
                    ids.insert(id, spec);
                    continue;
                }
                (TYPE_BOOL, &[_, id]) => _ = self.booleans.insert(id),
                (TYPE_INT, &[_, id, 32, _]) => _ = self.integers.insert(id),
                (CONSTANT, &[_, kind, id, value]) if self.integers.contains(&kind) => {
                    self.values[id as usize] = Known(value);
                }
                (CONSTANT_TRUE, &[_, _, id]) => self.values[id as usize] = Known(1),
                (CONSTANT_FALSE, &[_, _, id]) => self.values[id as usize] = Known(0),
                (SPEC_CONSTANT, &[_, kind, id, default]) => {
                    let value = given(id).unwrap_or(default);
                    if self.integers.contains(&kind) {
                        self.values[id as usize] = Known(value);
                    }
                    push(out, CONSTANT, &[kind, id, value]);
                    continue;
                }
                (SPEC_CONSTANT_TRUE | SPEC_CONSTANT_FALSE, &[_, kind, id]) => {
                    let default = u32::from(opcode == SPEC_CONSTANT_TRUE);
                    let value = u32::from(given(id).unwrap_or(default) != 0);
                    self.values[id as usize] = Known(value);
                    push(out, if value == 1 { CONSTANT_TRUE } else { CONSTANT_FALSE }, &[kind, id]);
                    continue;
                }
                (SPEC_CONSTANT_COMPOSITE, words) => {
                    push(out, CONSTANT_COMPOSITE, &words[1..]);
                    continue;
                }
                (SPEC_CONSTANT_OP, &[_, kind, id, operation, ref operands @ ..]) => {
                    if let Known(value) = self.operation(operation, kind, operands) {
                        self.values[id as usize] = Known(value);
                        match (self.integers.contains(&kind), value) {
                            (true, _) => push(out, CONSTANT, &[kind, id, value]),
                            (false, 0) => push(out, CONSTANT_FALSE, &[kind, id]),
                            (false, _) => push(out, CONSTANT_TRUE, &[kind, id]),
                        }
                        continue;
                    }
                }
                _ => {}
            }
            out.extend(words);
        }
        self.code.len()
    }

    fn value(&self, id: u32) -> Value {
        self.values[id as usize]
    }

    /// Whether results of this operation and type are followed.
    fn follows(&self, opcode: u32, kind: u32) -> bool {
        match opcode {
            PHI | SELECT | COPY_OBJECT => {
                self.booleans.contains(&kind) || self.integers.contains(&kind)
            }
            LOGICAL_EQUAL..=LOGICAL_NOT | EQUAL..=S_LESS_EQUAL => self.booleans.contains(&kind),
            _ => false,
        }
    }

    fn operation(&self, opcode: u32, kind: u32, operands: &[u32]) -> Value {
        if !self.follows(opcode, kind) {
            return Varying;
        }
        let mut of = [Varying; 3];
        for (of, id) in of.iter_mut().zip(operands) {
            *of = self.value(*id);
        }
        result(opcode, &of[..operands.len().min(3)])
    }
}

struct Block {
    label: u32,
    /// Place of the instructions between the label and the branch, without the declaration of a merge.
    body: Range<usize>,
    /// Place of the declaration of a merge.
    merge: Option<usize>,
    /// Place of the last instruction.
    end: usize,
}

struct Function<'a> {
    code: &'a [u32],
    /// Place of what precedes the first block.
    head: Range<usize>,
    blocks: Vec<Block>,
    /// Index of the block with a label.
    index: HashMap<u32, usize>,
}

/// Which code of a function runs.
#[derive(Default)]
struct Live {
    blocks: BTreeSet<usize>,
    /// Pairs of blocks of which the first branches to the second.
    edges: HashSet<(usize, usize)>,
}

impl<'a> Function<'a> {
    /// `None` if a function has no blocks.
    fn new(code: &'a [u32], range: Range<usize>) -> Option<Self> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut head = range.clone();
        for (at, opcode, words) in instructions(code, range.clone()) {
            let next = at + words.len();
            match (opcode, blocks.last_mut()) {
                (LABEL, last) => {
                    if last.is_none() {
                        head.end = at;
                    }
                    blocks.push(Block { label: words[1], body: next..next, merge: None, end: at });
                }
                (FUNCTION_END, _) | (_, None) => {}
                (_, Some(block)) => {
                    if block.merge.is_none() {
                        block.body.end = at;
                    }
                    if matches!(opcode, LOOP_MERGE | SELECTION_MERGE) {
                        block.merge = Some(at);
                    }
                    block.end = at;
                }
            }
        }
        let index = blocks.iter().enumerate().map(|(i, block)| (block.label, i)).collect();
        (!blocks.is_empty()).then_some(Self { code, head, blocks, index })
    }

    fn at(&self, place: usize) -> (u32, &'a [u32]) {
        let word = self.code[place];
        (word & 0xffff, &self.code[place..place + (word >> 16) as usize])
    }

    /// The blocks to which a block branches, whatever its condition.
    fn targets(&self, block: usize) -> Vec<usize> {
        let labels: Vec<u32> = match self.at(self.blocks[block].end) {
            (BRANCH, words) => vec![words[1]],
            (BRANCH_CONDITIONAL, words) => vec![words[2], words[3]],
            (SWITCH, words) => {
                std::iter::once(words[2]).chain(words[3..].chunks(2).map(|case| case[1])).collect()
            }
            _ => Vec::new(),
        };
        labels.iter().map(|label| self.index[label]).collect()
    }

    /// The one target of a conditional branch whose condition is known.
    fn decided(&self, module: &Module<'_>, block: usize) -> Option<usize> {
        let (BRANCH_CONDITIONAL, words) = self.at(self.blocks[block].end) else { return None };
        let Known(value) = module.value(words[1]) else { return None };
        Some(self.index[&words[if value != 0 { 2 } else { 3 }]])
    }

    /// Finds what runs (conditional constant propagation, Wegman and Zadeck 1991). The branches of the `whole` blocks
    /// all count as taken.
    fn live(&self, module: &mut Module<'_>, whole: &BTreeSet<usize>) -> Live {
        for block in &self.blocks {
            for (_, opcode, words) in instructions(self.code, block.body.clone()) {
                if words.len() > 2 && module.follows(opcode, words[1]) {
                    module.values[words[2] as usize] = Open;
                }
            }
        }
        let mut live = Live::default();
        live.blocks.insert(0);
        let mut changed = true;
        while changed {
            changed = false;
            for (i, block) in self.blocks.iter().enumerate() {
                if !live.blocks.contains(&i) {
                    continue;
                }
                for (_, opcode, words) in instructions(self.code, block.body.clone()) {
                    if words.len() < 3 || !module.follows(opcode, words[1]) {
                        continue;
                    }
                    let value = match opcode {
                        PHI => self.joined(module, &live, i, &words[3..]),
                        _ => module.operation(opcode, words[1], &words[3..]),
                    };
                    let old = &mut module.values[words[2] as usize];
                    changed |= *old != value;
                    *old = value;
                }
                let targets = match self.decided(module, i) {
                    Some(one) if !whole.contains(&i) => vec![one],
                    _ if self.is_open(module, i) && !whole.contains(&i) => Vec::new(),
                    _ => self.targets(i),
                };
                for target in targets {
                    changed |= live.blocks.insert(target) | live.edges.insert((i, target));
                }
            }
        }
        live
    }

    fn is_open(&self, module: &Module<'_>, block: usize) -> bool {
        let (opcode, words) = self.at(self.blocks[block].end);
        opcode == BRANCH_CONDITIONAL && module.value(words[1]) == Open
    }

    /// The value of a phi: that of all its parents that run, if they agree.
    fn joined(&self, module: &Module<'_>, live: &Live, block: usize, pairs: &[u32]) -> Value {
        let mut all = Open;
        for pair in pairs.chunks_exact(2) {
            if live.edges.contains(&(self.index[&pair[1]], block)) {
                all = match (all, module.value(pair[0])) {
                    (Open, other) | (other, Open) => other,
                    (a, b) if a == b => a,
                    _ => Varying,
                };
            }
        }
        all
    }

    /// Writes the function without the code that does not run.
    fn prune(&self, module: &mut Module<'_>, out: &mut Vec<u32>) {
        let mut whole = BTreeSet::new();
        let live = loop {
            let live = self.live(module, &whole);
            let more = self.unsound(module, &live, &whole);
            if more.is_subset(&whole) {
                break live;
            }
            whole.extend(more);
        };
        let decided: Vec<Option<usize>> = (0..self.blocks.len())
            .map(|i| self.decided(module, i).filter(|_| !whole.contains(&i)))
            .collect();
        // Merges of constructs that stay must exist, even if nothing branches to them.
        let mut stubs = BTreeSet::new();
        for &i in &live.blocks {
            if let Some(merge) = self.merge(i).filter(|_| self.keeps_merge(&live, i, decided[i])) {
                stubs.insert(merge);
            }
        }
        out.extend(&self.code[self.head.clone()]);
        for (i, block) in self.blocks.iter().enumerate() {
            if !live.blocks.contains(&i) {
                // Instructions with a result begin with its type.
                for (_, _, words) in instructions(self.code, block.body.clone()) {
                    if words.len() > 2 && module.types.contains(&words[1]) {
                        module.removed.insert(words[2]);
                    }
                }
                if stubs.contains(&i) {
                    push(out, LABEL, &[block.label]);
                    push(out, UNREACHABLE, &[]);
                } else {
                    module.removed.insert(block.label);
                }
                continue;
            }
            push(out, LABEL, &[block.label]);
            for (_, opcode, words) in instructions(self.code, block.body.clone()) {
                if opcode == PHI {
                    let mut operands = words[1..3].to_vec();
                    for pair in words[3..].chunks_exact(2) {
                        if live.edges.contains(&(self.index[&pair[1]], i)) {
                            operands.extend(pair);
                        }
                    }
                    push(out, PHI, &operands);
                } else {
                    out.extend(words);
                }
            }
            if let Some(merge) = block.merge.filter(|_| self.keeps_merge(&live, i, decided[i])) {
                out.extend(self.at(merge).1);
            }
            match decided[i] {
                Some(target) => push(out, BRANCH, &[self.blocks[target].label]),
                None => out.extend(self.at(block.end).1),
            }
        }
        push(out, FUNCTION_END, &[]);
    }

    /// The block in which the construct of a header block ends.
    fn merge(&self, block: usize) -> Option<usize> {
        let words = self.at(self.blocks[block].merge?).1;
        Some(self.index[&words[1]])
    }

    /// Whether a block with the declaration of a merge is still the header of a loop or selection.
    fn keeps_merge(&self, live: &Live, block: usize, decided: Option<usize>) -> bool {
        match self.blocks[block].merge.map(|merge| self.at(merge).0) {
            Some(LOOP_MERGE) => {
                (block..self.blocks.len()).any(|b| live.edges.contains(&(b, block)))
            }
            _ => decided.is_none(),
        }
    }

    /// Blocks that must stay whole: those of a loop or selection that would lose its header although conditional
    /// branches inside leave it, which only the inside of a loop or selection may do.
    fn unsound(
        &self,
        module: &Module<'_>,
        live: &Live,
        whole: &BTreeSet<usize>,
    ) -> BTreeSet<usize> {
        let decided = |i: usize| self.decided(module, i).filter(|_| !whole.contains(&i));
        let mut left = HashMap::new();
        for &i in &live.blocks {
            let targets = self.targets(i);
            if decided(i).is_none() && targets.len() > 1 {
                for target in targets {
                    left.entry(target).or_insert_with(Vec::new).push(i);
                }
            }
        }
        let is_left = |target: usize, header: Option<usize>| {
            left.get(&target).is_some_and(|from| from.iter().any(|from| Some(*from) != header))
        };
        let mut more = BTreeSet::new();
        for &i in &live.blocks {
            let Some(merge) = self.merge(i).filter(|_| !self.keeps_merge(live, i, decided(i)))
            else {
                continue;
            };
            let (opcode, words) = self.at(self.blocks[i].merge.expect("is a header"));
            if opcode == SELECTION_MERGE && is_left(merge, Some(i)) {
                more.insert(i);
            }
            if opcode == LOOP_MERGE {
                let next = self.index[&words[2]];
                if is_left(merge, None) || is_left(next, None) {
                    more.extend(i..merge.max(next + 1));
                }
            }
        }
        more
    }
}

#[cfg(test)]
mod tests;
