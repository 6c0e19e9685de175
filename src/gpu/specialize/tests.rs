//! Random programs compute the same before and after; every shader stays a well-formed module.

use std::collections::BTreeSet;

use super::*;

const UNDEF: u32 = 1;
const DECORATION_NO_CONTRACTION: u32 = 42;
const MEMBER_NAME: u32 = 6;
const FUNCTION_PARAMETER: u32 = 55;
const VARIABLE: u32 = 59;
const STORE: u32 = 62;
const MEMBER_DECORATE: u32 = 72;
const I_ADD: u32 = 128;
const RETURN: u32 = 253;

/// Ids of the random programs.
const VOID: u32 = 1;
const SIGNATURE: u32 = 2;
const INT: u32 = 3;
const BOOL: u32 = 4;
const TARGET: u32 = 5;
const LITERALS: Range<u32> = 10..14;
const SPECIAL: Range<u32> = 20..24;
/// `SPECIAL[i] == LITERALS[i]`, and two with values of their own.
const FLAGS: Range<u32> = 30..36;
const INPUTS: Range<u32> = 40..43;
const MAIN: u32 = 50;
const FIRST_FREE: u32 = 60;

/// A linear congruential generator.
struct Random(u32);

impl Random {
    fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) % n
    }

    fn of(&mut self, ids: Range<u32>) -> u32 {
        ids.start + self.below(ids.end - ids.start)
    }
}

/// Writes a random function as a compiler of GLSL would: nested selections and loops with breaks, continues and
/// returns. A value and a flag go through all of it, by phis.
struct Program {
    random: Random,
    code: Vec<u32>,
    next: u32,
    /// The block that is being written; 0 after its end.
    block: u32,
}

/// What goes through the program: an integer and a boolean.
type State = [u32; 2];

/// Where the breaks and continues of a loop go, and with which states they arrive.
struct Loop {
    merge: u32,
    next: u32,
    breaks: Vec<(u32, State)>,
    continues: Vec<(u32, State)>,
}

impl Program {
    /// The words of a module with a random function.
    fn module(seed: u32) -> Vec<u32> {
        let mut program =
            Self { random: Random(seed), code: Vec::new(), next: FIRST_FREE, block: 0 };
        program.emit(FUNCTION, &[VOID, MAIN, 0, SIGNATURE]);
        for input in INPUTS {
            program.emit(FUNCTION_PARAMETER, &[INT, input]);
        }
        let entry = program.id();
        program.begin(entry);
        let state = [program.random.of(LITERALS), program.random.of(FLAGS)];
        if program.statements(3, state, None).is_some() {
            program.end(RETURN, &[]);
        }
        program.emit(FUNCTION_END, &[]);
        let function = program.code.clone();
        program.code = vec![0x0723_0203, 0x0001_0300, 0, program.next, 0];
        // All results have a name and a decoration, so that those of removed code must go.
        for id in FIRST_FREE..program.next {
            program.emit(NAME, &[id, 0]);
            program.emit(DECORATE, &[id, DECORATION_NO_CONTRACTION]);
        }
        for (i, id) in SPECIAL.chain(FLAGS.skip(4)).enumerate() {
            program.emit(DECORATE, &[id, SPEC_ID, i as u32]);
        }
        program.emit(TYPE_VOID, &[VOID]);
        program.emit(TYPE_INT, &[INT, 32, 1]);
        program.emit(TYPE_BOOL, &[BOOL]);
        for (i, id) in LITERALS.enumerate() {
            program.emit(CONSTANT, &[INT, id, i as u32]);
        }
        for id in SPECIAL {
            program.emit(SPEC_CONSTANT, &[INT, id, 1]);
        }
        for (flag, (a, b)) in FLAGS.zip(SPECIAL.zip(LITERALS)) {
            program.emit(SPEC_CONSTANT_OP, &[BOOL, flag, EQUAL, a, b]);
        }
        program.emit(SPEC_CONSTANT_TRUE, &[BOOL, FLAGS.end - 2]);
        program.emit(SPEC_CONSTANT_FALSE, &[BOOL, FLAGS.end - 1]);
        program.code.extend(function);
        program.code
    }

    fn emit(&mut self, opcode: u32, operands: &[u32]) {
        push(&mut self.code, opcode, operands);
    }

    fn id(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }

    fn begin(&mut self, label: u32) {
        self.emit(LABEL, &[label]);
        self.block = label;
    }

    fn end(&mut self, opcode: u32, operands: &[u32]) {
        self.emit(opcode, operands);
        self.block = 0;
    }

    fn result(&mut self, opcode: u32, kind: u32, operands: &[u32]) -> u32 {
        let id = self.id();
        let words: Vec<u32> = [kind, id].iter().chain(operands).copied().collect();
        self.emit(opcode, &words);
        id
    }

    /// A condition that is known, one that depends on the inputs, or one of both.
    fn condition(&mut self, [value, flag]: State) -> u32 {
        let (known, input, literal) =
            (self.random.of(FLAGS), self.random.of(INPUTS), self.random.of(LITERALS));
        let varying = |program: &mut Self| program.result(S_LESS, BOOL, &[input, literal]);
        match self.random.below(9) {
            0..=1 => known,
            2 => flag,
            3 => self.result(LOGICAL_NOT, BOOL, &[known]),
            4 => self.result(EQUAL, BOOL, &[value, literal]),
            5 => varying(self),
            6 => {
                let varying = varying(self);
                self.result(LOGICAL_AND, BOOL, &[varying, known])
            }
            7 => {
                let varying = varying(self);
                self.result(LOGICAL_OR, BOOL, &[known, varying])
            }
            // A short-circuited `known && varying`.
            _ => {
                let [then, merge] = [self.id(), self.id()];
                let before = self.block;
                self.emit(SELECTION_MERGE, &[merge, 0]);
                self.end(BRANCH_CONDITIONAL, &[known, then, merge]);
                self.begin(then);
                let varying = varying(self);
                self.end(BRANCH, &[merge]);
                self.begin(merge);
                self.result(PHI, BOOL, &[known, before, varying, then])
            }
        }
    }

    /// Begins a block at which several arrive.
    fn join(&mut self, label: u32, arrivals: &[(u32, State)]) -> Option<State> {
        self.begin(label);
        if arrivals.is_empty() {
            self.end(UNREACHABLE, &[]);
            return None;
        }
        Some(self.phis(arrivals))
    }

    fn phis(&mut self, arrivals: &[(u32, State)]) -> State {
        [(INT, 0), (BOOL, 1)].map(|(kind, part)| {
            let pairs: Vec<u32> =
                arrivals.iter().flat_map(|(block, state)| [state[part], *block]).collect();
            self.result(PHI, kind, &pairs)
        })
    }

    /// The state after some statements, unless they never end.
    fn statements(
        &mut self,
        depth: u32,
        mut state: State,
        mut around: Option<&mut Loop>,
    ) -> Option<State> {
        for _ in 0..1 + self.random.below(3) {
            let literal = self.random.of(LITERALS);
            self.emit(STORE, &[TARGET, state[0]]);
            match self.random.below(if depth > 0 { 8 } else { 3 }) {
                0 => state[0] = self.result(I_ADD, INT, &[state[0], literal]),
                1 => {
                    state[1] = self.condition(state);
                    state[0] = self.result(SELECT, INT, &[state[1], literal, state[0]]);
                }
                2 => state = self.leave(state, around.as_deref_mut())?,
                3..=4 => state = self.selection(depth - 1, state, around.as_deref_mut())?,
                5 => state = self.switch(depth - 1, state, around.as_deref_mut())?,
                _ => state = self.repeat(depth - 1, state)?,
            }
        }
        Some(state)
    }

    /// `if (condition) break;`, or continue or return.
    fn leave(&mut self, state: State, mut around: Option<&mut Loop>) -> Option<State> {
        let condition = self.condition(state);
        let before = self.block;
        // What leaves a loop needs no selection of its own.
        if let Some(around) = around.as_deref_mut()
            && self.random.below(2) == 0
        {
            let rest = self.id();
            let (to, arrivals) = match self.random.below(2) {
                0 => (around.merge, &mut around.breaks),
                _ => (around.next, &mut around.continues),
            };
            arrivals.push((before, state));
            self.end(BRANCH_CONDITIONAL, &[condition, to, rest]);
            return self.join(rest, &[(before, state)]);
        }
        let [then, merge] = [self.id(), self.id()];
        self.emit(SELECTION_MERGE, &[merge, 0]);
        self.end(BRANCH_CONDITIONAL, &[condition, then, merge]);
        self.begin(then);
        match (around, self.random.below(3)) {
            (Some(around), 0) => {
                around.breaks.push((then, state));
                self.end(BRANCH, &[around.merge]);
            }
            (Some(around), 1) => {
                around.continues.push((then, state));
                self.end(BRANCH, &[around.next]);
            }
            _ => self.end(RETURN, &[]),
        }
        self.join(merge, &[(before, state)])
    }

    fn selection(
        &mut self,
        depth: u32,
        state: State,
        mut around: Option<&mut Loop>,
    ) -> Option<State> {
        let condition = self.condition(state);
        let [then, merge] = [self.id(), self.id()];
        let has_other = self.random.below(2) == 0;
        let other = if has_other { self.id() } else { merge };
        let mut arrivals = Vec::new();
        let before = self.block;
        self.emit(SELECTION_MERGE, &[merge, 0]);
        self.end(BRANCH_CONDITIONAL, &[condition, then, other]);
        for (label, is_there) in [(then, true), (other, has_other)] {
            if !is_there {
                arrivals.push((before, state));
                continue;
            }
            self.begin(label);
            if let Some(mut state) = self.statements(depth, state, around.as_deref_mut()) {
                // A conditional branch may leave its selection.
                if self.random.below(4) == 0 {
                    let condition = self.condition(state);
                    let rest = self.id();
                    arrivals.push((self.block, state));
                    self.end(BRANCH_CONDITIONAL, &[condition, merge, rest]);
                    self.begin(rest);
                    state[0] = self.random.of(LITERALS);
                }
                arrivals.push((self.block, state));
                self.end(BRANCH, &[merge]);
            }
        }
        self.join(merge, &arrivals)
    }

    fn switch(&mut self, depth: u32, state: State, mut around: Option<&mut Loop>) -> Option<State> {
        let [one, two, merge] = [self.id(), self.id(), self.id()];
        let on = if self.random.below(2) == 0 { state[0] } else { self.random.of(SPECIAL) };
        let mut arrivals = vec![(self.block, state)];
        self.emit(SELECTION_MERGE, &[merge, 0]);
        self.end(SWITCH, &[on, merge, 0, one, 1, two]);
        for label in [one, two] {
            self.begin(label);
            if let Some(state) = self.statements(depth, state, around.as_deref_mut()) {
                arrivals.push((self.block, state));
                self.end(BRANCH, &[merge]);
            }
        }
        self.join(merge, &arrivals)
    }

    /// A loop of at most three rounds; of none, if a constant says so.
    fn repeat(&mut self, depth: u32, before: State) -> Option<State> {
        let [header, test, body, next, merge] = std::array::from_fn(|_| self.id());
        let [zero, one] = [LITERALS.start, LITERALS.start + 1];
        let limits = [LITERALS, SPECIAL, INPUTS][self.random.below(3) as usize].clone();
        let limit = self.random.of(limits);
        let from = self.block;
        self.end(BRANCH, &[header]);
        self.begin(header);
        // The phis of the header name what the continue block will compute.
        let [index, value, flag] = std::array::from_fn(|_| self.id());
        let [next_index, next_value, next_flag] = std::array::from_fn(|_| self.id());
        self.emit(PHI, &[INT, index, zero, from, next_index, next]);
        self.emit(PHI, &[INT, value, before[0], from, next_value, next]);
        self.emit(PHI, &[BOOL, flag, before[1], from, next_flag, next]);
        let state = [value, flag];
        self.emit(LOOP_MERGE, &[merge, next, 0]);
        self.end(BRANCH, &[test]);
        self.begin(test);
        let mut inner = Loop { merge, next, breaks: Vec::new(), continues: Vec::new() };
        let tests_last = self.random.below(3) == 0;
        if tests_last {
            self.end(BRANCH, &[body]);
        } else {
            let goes_on = self.result(S_LESS, BOOL, &[index, limit]);
            self.end(BRANCH_CONDITIONAL, &[goes_on, body, merge]);
            inner.breaks.push((test, state));
        }
        self.begin(body);
        if let Some(state) = self.statements(depth, state, Some(&mut inner)) {
            inner.continues.push((self.block, state));
            self.end(BRANCH, &[next]);
        }
        self.begin(next);
        let state = if inner.continues.is_empty() { state } else { self.phis(&inner.continues) };
        self.emit(COPY_OBJECT, &[INT, next_value, state[0]]);
        self.emit(COPY_OBJECT, &[BOOL, next_flag, state[1]]);
        self.emit(I_ADD, &[INT, next_index, index, one]);
        if tests_last {
            let goes_on = self.result(S_LESS, BOOL, &[next_index, limit]);
            let known = self.random.of(FLAGS);
            let goes_on = self.result(LOGICAL_AND, BOOL, &[goes_on, known]);
            self.end(BRANCH_CONDITIONAL, &[goes_on, header, merge]);
            inner.breaks.push((next, [next_value, next_flag]));
        } else {
            self.end(BRANCH, &[header]);
        }
        self.join(merge, &inner.breaks)
    }
}

/// What a program stores, with these specialization constants and inputs.
fn run(code: &[u32], constants: &[(u32, u32)], inputs: [u32; 3]) -> Vec<u32> {
    let mut values: HashMap<u32, u32> = INPUTS.zip(inputs).collect();
    let mut blocks = HashMap::new();
    let mut specs = HashMap::new();
    let mut at = 0;
    for (place, opcode, words) in instructions(code, HEADER..code.len()) {
        let given = |default| {
            let spec = specs.get(&words[2]);
            constants.iter().find(|(id, _)| Some(id) == spec).map_or(default, |given| given.1)
        };
        let value = match opcode {
            LABEL => {
                if blocks.is_empty() {
                    at = place;
                }
                blocks.insert(words[1], place);
                continue;
            }
            DECORATE if words[2] == SPEC_ID => {
                specs.insert(words[1], words[3]);
                continue;
            }
            CONSTANT => words[3],
            CONSTANT_TRUE | CONSTANT_FALSE => (opcode == CONSTANT_TRUE).into(),
            SPEC_CONSTANT => given(words[3]),
            SPEC_CONSTANT_TRUE => (given(1) != 0).into(),
            SPEC_CONSTANT_FALSE => (given(0) != 0).into(),
            SPEC_CONSTANT_OP => (values[&words[4]] == values[&words[5]]).into(),
            _ => continue,
        };
        values.insert(words[2], value);
    }
    let mut stored = Vec::new();
    let (mut block, mut before) = (0, 0);
    loop {
        let mut to = None;
        // Phis read what was there before any of them was written.
        let old = values.clone();
        for (_, opcode, words) in instructions(code, at..code.len()) {
            let of = |i: usize| values[&words[i]];
            let value = match opcode {
                LABEL => {
                    (before, block) = (block, words[1]);
                    continue;
                }
                PHI => {
                    let mut pairs = words[3..].chunks(2);
                    old[&pairs.find(|pair| pair[1] == before).expect("has this parent")[0]]
                }
                COPY_OBJECT => of(3),
                SELECT => of(if of(3) != 0 { 4 } else { 5 }),
                I_ADD => of(3).wrapping_add(of(4)),
                S_LESS => ((of(3) as i32) < of(4) as i32).into(),
                EQUAL => (of(3) == of(4)).into(),
                LOGICAL_NOT => (of(3) == 0).into(),
                LOGICAL_AND => of(3) & of(4),
                LOGICAL_OR => of(3) | of(4),
                STORE => {
                    stored.push(of(2));
                    continue;
                }
                SELECTION_MERGE | LOOP_MERGE => continue,
                BRANCH => {
                    to = Some(words[1]);
                    break;
                }
                BRANCH_CONDITIONAL => {
                    to = Some(words[if of(1) != 0 { 2 } else { 3 }]);
                    break;
                }
                SWITCH => {
                    let case = words[3..].chunks(2).find(|case| case[0] == of(1));
                    to = Some(case.map_or(words[2], |case| case[1]));
                    break;
                }
                RETURN => break,
                other => panic!("instruction {other}"),
            };
            values.insert(words[2], value);
        }
        match to {
            Some(label) => at = blocks[&label],
            None => return stored,
        }
    }
}

/// Finds what makes a module malformed.
fn check(code: &[u32]) -> Result<(), String> {
    let (mut types, mut results) = (BTreeSet::new(), BTreeSet::new());
    let mut end = HEADER;
    let mut first = None;
    for (at, opcode, words) in instructions(code, HEADER..code.len()) {
        if at != end || words.len() != (words[0] >> 16) as usize {
            return Err(format!("words are left over at {end}"));
        }
        end = at + words.len();
        match opcode {
            FUNCTION => first = first.or(Some(at)),
            SPEC_CONSTANT_TRUE..=SPEC_CONSTANT_COMPOSITE => return Err("a constant is open".into()),
            DECORATE if words[2] == SPEC_ID => return Err("a SpecId is left".into()),
            _ => {}
        }
        if first.is_none() {
            match opcode {
                TYPE_VOID..=TYPE_FORWARD_POINTER => _ = types.insert(words[1]),
                CONSTANT_TRUE..FUNCTION | VARIABLE | UNDEF => _ = results.insert(words[2]),
                _ => {}
            }
        }
    }
    let first = first.ok_or("no function")?;
    let mut start = first;
    for (at, opcode, words) in instructions(code, first..code.len()) {
        if opcode == LABEL {
            results.insert(words[1]);
        } else if words.len() > 2 && types.contains(&words[1]) && !results.insert(words[2]) {
            return Err(format!("{} is there twice", words[2]));
        }
        if opcode == FUNCTION_END {
            check_function(code, start..at)?;
            start = at + words.len();
        }
    }
    for (_, opcode, words) in instructions(code, HEADER..first) {
        let is_there =
            types.contains(&words[1]) || results.contains(&words[1]) || is_external(code, words[1]);
        if matches!(opcode, NAME | DECORATE | MEMBER_NAME | MEMBER_DECORATE) && !is_there {
            return Err(format!("{} is named or decorated, but is not there", words[1]));
        }
    }
    Ok(())
}

/// Whether an id is of a kind that stands before the types: a set of instructions or a string.
fn is_external(code: &[u32], id: u32) -> bool {
    const STRING: u32 = 7;
    const EXT_INST_IMPORT: u32 = 11;
    instructions(code, HEADER..code.len())
        .any(|(_, opcode, words)| matches!(opcode, STRING | EXT_INST_IMPORT) && words[1] == id)
}

fn check_function(code: &[u32], range: Range<usize>) -> Result<(), String> {
    let Some(function) = Function::new(code, range) else { return Ok(()) };
    let labels: BTreeSet<u32> = function.index.keys().copied().collect();
    let mut exits: BTreeSet<u32> = BTreeSet::new();
    for block in &function.blocks {
        if let Some(place) = block.merge {
            let (opcode, words) = function.at(place);
            let ends = &words[1..if opcode == LOOP_MERGE { 3 } else { 2 }];
            if let Some(lost) = ends.iter().find(|label| !labels.contains(label)) {
                return Err(format!("the merge {lost} of {} is not there", block.label));
            }
            exits.extend(ends);
        }
        if !(BRANCH..=UNREACHABLE).contains(&function.at(block.end).0) {
            return Err(format!("block {} has no end", block.label));
        }
    }
    let targets: Vec<Vec<usize>> = (0..function.blocks.len())
        .map(|i| {
            let (opcode, words) = function.at(function.blocks[i].end);
            let labels = match opcode {
                BRANCH => &words[1..],
                BRANCH_CONDITIONAL => &words[2..],
                _ => &[],
            };
            match labels.iter().find(|label| !function.index.contains_key(label)) {
                Some(lost) => Err(format!("the target {lost} is not there")),
                None => Ok(function.targets(i)),
            }
        })
        .collect::<Result<_, _>>()?;
    for (i, block) in function.blocks.iter().enumerate() {
        let parents: BTreeSet<u32> = (0..targets.len())
            .filter(|from| targets[*from].contains(&i))
            .map(|from| function.blocks[from].label)
            .collect();
        for (_, opcode, words) in instructions(code, block.body.clone()) {
            let named: BTreeSet<u32> = words.iter().skip(4).step_by(2).copied().collect();
            if opcode == PHI && named != parents {
                return Err(format!("a phi of {} has {named:?} for {parents:?}", block.label));
            }
        }
        let is_header = block.merge.is_some();
        if !is_header
            && targets[i].len() > 1
            && !targets[i].iter().any(|to| exits.contains(&function.blocks[*to].label))
        {
            return Err(format!("{} selects without a merge", block.label));
        }
        let is_loop = block.merge.is_some_and(|place| function.at(place).0 == LOOP_MERGE);
        let back = (i..targets.len()).filter(|from| targets[*from].contains(&i)).count();
        if back != usize::from(is_loop) {
            return Err(format!("{back} branches go back to {}", block.label));
        }
    }
    Ok(())
}

/// Constants with which most code of the programs is known to run or not.
fn constants(random: &mut Random) -> Vec<(u32, u32)> {
    let given: Vec<u32> = (0..6).filter(|_| random.below(4) > 0).collect();
    given.into_iter().map(|id| (id, random.below(3))).collect()
}

#[test]
fn random_programs_compute_the_same() {
    let mut random = Random(1);
    let (mut before, mut after, mut stores) = (0, 0, 0);
    for seed in 0..4000 {
        let program = Program::module(seed);
        for _ in 0..4 {
            let constants = constants(&mut random);
            let special = specialized(&program, &constants);
            check(&special)
                .unwrap_or_else(|error| panic!("program {seed}, {constants:?}: {error}"));
            for _ in 0..4 {
                let inputs = std::array::from_fn(|_| random.below(4));
                let expected = run(&program, &constants, inputs);
                assert_eq!(run(&special, &[], inputs), expected, "program {seed}, {constants:?}");
                stores += expected.len();
            }
            before += program.len();
            after += special.len();
        }
    }
    assert!(stores > 100_000, "{stores}");
    println!("{before} words become {after}");
    assert!(after < before * 3 / 4, "{before} words become {after}");
}

#[test]
fn every_shader_stays_well_formed() {
    let mut random = Random(1);
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("spirv");
    let mut shaders = 0;
    for file in std::fs::read_dir(folder).expect("is shipped") {
        let path = file.expect("can be listed").path();
        if path.extension().is_none_or(|extension| extension != "spv") {
            continue;
        }
        let bytes = std::fs::read(&path).expect("can be read");
        let code: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        for _ in 0..8 {
            let constants: Vec<(u32, u32)> = (0..40).map(|id| (id, random.below(3))).collect();
            let special = specialized(&code, &constants);
            check(&special)
                .unwrap_or_else(|error| panic!("{}, {constants:?}: {error}", path.display()));
        }
        shaders += 1;
    }
    assert!(shaders > 50, "{shaders} shaders");
}

/// With its defaults (no foam, no ripples, no shore), the composite keeps a third of its code.
#[test]
fn unused_code_of_the_composite_is_removed() {
    let code: &[u32] = bytemuck::cast_slice(crate::gpu::shader::COMPOSITE_COMP.code);
    let special = specialized(code, &[]);
    assert!(special.len() < code.len() / 2, "{} of {} words", special.len(), code.len());
}
