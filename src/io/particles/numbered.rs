//! Names of columns with the columns' numbers, as comments above a table have them: `# 1:x 2:y`, `# [1] x [2] y`,
//! `# (1) x (2) y`, `# 1 x 2 y`, `# col1: x, col2: y`, or one in each line: `# $1 = time [s]`.

use super::names;

/// How a number is marked; all numbers of a line are marked alike.
#[derive(Clone, Copy, PartialEq)]
struct Style {
    /// Whether a word such as `column` is before the number.
    word: bool,
    open: Option<char>,
    close: Option<char>,
    /// The character between the number and the name; `None` for white space.
    between: Option<char>,
}

/// The number of a column, with what marks it.
struct Mark {
    number: usize,
    style: Style,
    /// Its length in bytes.
    length: usize,
}

/// Words before the number of a column; a longer one comes before its beginning.
const WORDS: [&str; 8] = ["columns", "column", "col", "fields", "field", "variable", "var", "c"];

/// Max number of names that are in a line each.
const MOST: usize = 256;

/// Max number of digits of a column's number.
const DIGITS: usize = 3;

impl Mark {
    /// The mark that begins a text.
    fn of(text: &str) -> Option<Self> {
        let word = WORDS.iter().find_map(|word| {
            let (start, rest) = text.split_at_checked(word.len())?;
            start.eq_ignore_ascii_case(word).then_some(rest)
        });
        let rest = word.map_or(text, |rest| rest.trim_start_matches([' ', '\t', '_', '.']));
        let open = rest.chars().next().filter(|c| "[(<{$#".contains(*c));
        let rest = open.map_or(rest, |open| rest.strip_prefix(open).unwrap_or(rest)).trim_start();
        let count = rest.bytes().take_while(u8::is_ascii_digit).count();
        let number = rest.get(..count).filter(|_| count <= DIGITS)?.parse().ok()?;
        let behind = rest.get(count..)?;
        let closing = match open {
            Some('[') => Some(']'),
            Some('(') => Some(')'),
            Some('<') => Some('>'),
            Some('{') => Some('}'),
            _ => None,
        };
        let inner = behind.trim_start();
        let close = match closing {
            Some(closing) => Some(inner.strip_prefix(closing).map(|_| closing)?),
            None => inner.starts_with(')').then_some(')'),
        };
        let behind = close.map_or(behind, |close| inner.strip_prefix(close).unwrap_or(inner));
        let inner = behind.trim_start();
        let between = inner.chars().next().filter(|c| ":=.-".contains(*c));
        let rest = between.map_or(behind, |between| inner.strip_prefix(between).unwrap_or(inner));
        // `1.5` and `1-2` are other numbers, and `2e` begins a word.
        let digit = rest.starts_with(|c: char| c.is_ascii_digit());
        let apart = rest.is_empty() || rest.starts_with(char::is_whitespace);
        if (between.is_some() && digit) || (between.is_none() && close.is_none() && !apart) {
            return None;
        }
        let style = Style { word: word.is_some(), open, close, between };
        Some(Self { number, style, length: text.len() - rest.len() })
    }
}

/// The name of one column: without what separates it from the next one.
fn cleaned(name: &str) -> &str {
    let cut = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '|' | '=' | ':' | '"' | '\'');
    name.trim_matches(cut)
}

/// Whether a text can be a name.
fn is_name(text: &str) -> bool {
    text.contains(char::is_alphabetic) && text.parse::<f64>().is_err()
}

/// The names in a line, if all of it is numbered columns from 0 or 1 on, at least two.
pub(super) fn names(line: &str) -> Option<Vec<String>> {
    let line = cleaned(line);
    let first = Mark::of(line).filter(|mark| mark.number <= 1)?;
    let (mut found, mut number) = (Vec::new(), first.number);
    let mut rest = line.get(first.length..)?;
    loop {
        number += 1;
        // The next mark begins a word.
        let mut before = ' ';
        let next = rest.char_indices().find_map(|(at, c)| {
            let begins = before.is_whitespace() || matches!(before, ',' | ';' | '|');
            before = c;
            if !begins || c.is_whitespace() {
                return None;
            }
            let mark = Mark::of(rest.get(at..)?)?;
            (mark.number == number && mark.style == first.style).then_some((at, mark.length))
        });
        let (name, behind) = match next {
            Some((at, length)) => (rest.get(..at)?, Some(rest.get(at + length..)?)),
            None => (rest, None),
        };
        let name = cleaned(name);
        if !is_name(name) {
            return None;
        }
        found.push(name.to_string());
        match behind {
            Some(behind) => rest = behind,
            None => return (found.len() > 1).then_some(found),
        }
    }
}

/// Names in consecutive lines, one in each.
#[derive(Default)]
pub(super) struct List {
    names: Vec<String>,
    /// Number of the next column.
    next: usize,
    style: Option<Style>,
}

impl List {
    /// Adds a line without its comment mark, and returns all names so far if there is a new one, at least two.
    pub(super) fn add(&mut self, line: &str) -> Option<&[String]> {
        let line = line.trim();
        let mark = Mark::of(line)?;
        let name = known_in(cleaned(line.get(mark.length..)?));
        if !is_name(name) {
            return None;
        }
        if mark.number <= 1 && (mark.number != self.next || self.style != Some(mark.style)) {
            *self = Self { names: Vec::new(), next: mark.number, style: Some(mark.style) };
        }
        if mark.number != self.next || self.names.len() >= MOST || self.style != Some(mark.style) {
            return None;
        }
        self.next += 1;
        self.names.push(name.to_string());
        (self.names.len() > 1).then_some(&self.names)
    }
}

/// The name in a text that may also explain it: all of it, what is before a comma or the like, or its first word.
fn known_in(text: &str) -> &str {
    let known = |name: &str| names::known(&names::plain(name));
    if known(text) {
        return text;
    }
    let ends = [" - ", ",", ";", ": ", " = "].iter().filter_map(|end| text.find(end)).min();
    let head = ends.and_then(|end| text.get(..end)).map_or(text, cleaned);
    if known(head) {
        return head;
    }
    // `time step` is no time.
    let word = text.split_whitespace().next().unwrap_or(text);
    let word = cleaned(word);
    if known(word) && !names::is_time(word) { word } else { head }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_columns_are_no_part_of_their_names() {
        for (line, expected) in [
            ("1:x 2:y 3:z 4:vx", &["x", "y", "z", "vx"][..]),
            ("[1] x [2] y [3] z", &["x", "y", "z"]),
            ("[1]=time     [2]=x1 [3]=x2", &["time", "x1", "x2"]),
            ("(1) time (2) id (3) x", &["time", "id", "x"]),
            ("1 x 2 y", &["x", "y"]),
            ("col1: x, col2: y", &["x", "y"]),
            ("Column 0: x [m]; Column 1: y [m]", &["x [m]", "y [m]"]),
            ("1=x 2=y", &["x", "y"]),
            ("$1 = time [s] $2 = x [m]", &["time [s]", "x [m]"]),
            ("1) x 2) y", &["x", "y"]),
            ("1. x 2. particle id 3. v x", &["x", "particle id", "v x"]),
            ("0:x 1:y", &["x", "y"]),
            ("c1:x c2:y", &["x", "y"]),
            ("1:x 2:y of 3 3:z", &["x", "y of 3", "z"]),
        ] {
            assert!(names(line).is_some_and(|names| names == expected), "{line}");
        }
        for line in
            ["1 2 3", "1.5 x 2.5 y", "x y z", "2 x 3 y", "1 x", "1 x 3 y", "columns x y", ""]
        {
            let found = names(line);
            assert!(found.is_none(), "{line}: {found:?}");
        }
    }

    #[test]
    fn a_name_may_be_in_each_line() {
        let of = |lines: &[&str]| {
            let mut list = List::default();
            let all = lines.iter().filter_map(|line| list.add(line).map(<[String]>::to_vec));
            all.last().unwrap_or_default()
        };
        assert_eq!(of(&["column 1: x", "column 2: y"]), ["x", "y"]);
        let lines =
            ["written by p 1.5", "1 time [s]", "2 x position, in metres", "3 y of the particle"];
        assert_eq!(of(&lines), ["time [s]", "x position", "y"]);
        assert_eq!(of(&["$1 = time [s]", "$2 = altitude [km]"]), ["time [s]", "altitude [km]"]);
        assert_eq!(of(&["0: x", "1: y", "2: time step"]), ["x", "y", "time step"]);
        assert!(of(&["1 x", "3 y"]).is_empty());
        assert!(of(&["1 x", "(2) y"]).is_empty());
    }
}
