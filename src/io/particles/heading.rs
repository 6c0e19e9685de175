//! Detects the beginning of a text table: the separator of its fields, the names of its columns, and where
//! its rows begin.
//!
//! The names are in the line before the rows, with or without `#` in front; some programs write comments and
//! other lines above it. A line counts as the line of names if it contains names of positions and has as many
//! fields as the next line of numbers. In comments the columns may be numbered, in one line or a line each, see
//! `numbered`.

use super::blocks::Label;
use super::bytes::parse_number;
use super::error::ReadError;
use super::names::{self, have_positions, is_position, is_suffix};
use super::numbered;
use super::source::Content;
use super::tecplot;
use super::text::Text;

/// Max number of lines at the start of a file that are searched for the names of the columns: `LINES` without
/// counting comments, `ALL` with comments.
const LINES: usize = 64;
const ALL: usize = 4096;

/// Number of lines above the rows in which names that do not fit are told.
const NEAR: usize = 8;

/// The beginning of a table.
pub(super) struct Heading {
    /// Separator of the fields, such as a comma; `None` for white space, perhaps together with semicolons.
    pub(super) delimiter: Option<u8>,
    /// Names of the columns; empty without a line of names.
    pub(super) names: Vec<String>,
    /// Where the rows begin: byte offset, and number of lines before.
    pub(super) at: u64,
    pub(super) line: u64,
    /// Number of lines before the line of names (without names: before the rows) that are neither empty nor
    /// comments.
    pub(super) passed: u64,
    /// The line of names without its comment mark; empty without one.
    pub(super) text: Vec<u8>,
    /// A warning about a comment that names another number of columns than there are.
    pub(super) misfit: Option<String>,
}

/// A line, its byte offset, and that of the next line.
pub(super) struct Line {
    pub(super) text: Vec<u8>,
    pub(super) start: u64,
    pub(super) next: u64,
}

/// The first [`LINES`] lines of a file, and the comments between them.
pub(super) fn lines(content: &Content<'_>) -> Result<Vec<Line>, ReadError> {
    let mut text = Text::of(content)?;
    let (mut lines, mut others) = (Vec::new(), 0);
    while others < LINES && lines.len() < ALL {
        let start = text.at();
        let Some(line) = text.line()? else { break };
        let line = line.to_vec();
        others += usize::from(!is_comment(&line));
        lines.push(Line { text: line, start, next: text.at() });
    }
    Ok(tecplot::joined(lines))
}

/// The line without its comment mark, and whether it had one.
pub(super) fn uncommented(line: &[u8]) -> (&[u8], bool) {
    let line = line.trim_ascii();
    let mark = [&b"#"[..], b"%", b"//"].iter().find_map(|mark| line.strip_prefix(*mark));
    match mark {
        Some(rest) => (rest.trim_ascii_start(), true),
        None => (line, false),
    }
}

/// Whether a line is empty or a comment.
pub(super) fn is_comment(line: &[u8]) -> bool {
    let (rest, marked) = uncommented(line);
    marked || rest.is_empty() || tecplot::is_record(rest)
}

/// Whether a line is empty, a comment, or a time above rows.
fn is_between(line: &[u8]) -> bool {
    is_comment(line) || Label::alone(line.trim_ascii()).is_some()
}

/// The separator of a line of numbers. A comma is a decimal comma if there is another separator.
pub(super) fn delimiter(line: &[u8]) -> Option<u8> {
    let line = line.trim_ascii();
    let comma = line.contains(&b',');
    if line.contains(&b';') {
        return Some(b';');
    }
    let words = || line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let decimal = |word: &[u8]| !word.contains(&b',') || number_with_comma(word).is_some();
    if comma && !(words().count() > 1 && words().all(decimal)) {
        return Some(b',');
    }
    [b'\t', b'|'].into_iter().find(|d| line.contains(d))
}

/// The fields of a line, without empty ones at its end.
pub(super) fn fields(line: &[u8], delimiter: Option<u8>) -> Vec<String> {
    let Some(delimiter) = delimiter else { return words(line) };
    // To build a reader of CSV takes longer than to split a line.
    let mut fields = match line.iter().any(|b| matches!(b, b'"' | b'\r' | b'\n')) {
        true => quoted(line, delimiter),
        false => {
            let fields = line.split(|b| *b == delimiter);
            fields.map(|f| String::from_utf8_lossy(f).trim().to_string()).collect()
        }
    };
    while fields.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    fields
}

/// The fields of a line, which may be in quotes.
fn quoted(line: &[u8], delimiter: u8) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new();
    reader.has_headers(false).delimiter(delimiter).trim(csv::Trim::All);
    let mut record = csv::ByteRecord::new();
    match reader.from_reader(line).read_byte_record(&mut record) {
        Ok(true) => record.iter().map(|f| String::from_utf8_lossy(f).trim().to_string()).collect(),
        _ => Vec::new(),
    }
}

/// Splits a line at white space; units in brackets and quoted names stay whole.
fn words(line: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(line);
    let mut words: Vec<String> = Vec::new();
    let mut open = None;
    let mut inside = false;
    for c in text.chars() {
        match (open, c) {
            (None, '"' | '\'') => open = Some(c),
            (None, '[') => open = Some(']'),
            (None, '(') => open = Some(')'),
            (Some(end), c) if c == end => open = None,
            _ => {}
        }
        if open.is_none() && (c.is_whitespace() || c == ';') {
            inside = false;
            continue;
        }
        // A unit belongs to the name before it.
        let unit = !inside && matches!(c, '[' | '(') && !words.is_empty();
        if !inside && !unit {
            words.push(String::new());
        } else if unit {
            words.last_mut().into_iter().for_each(|word| word.push(' '));
        }
        inside = true;
        words.last_mut().into_iter().for_each(|word| word.push(c));
    }
    words.iter().map(|word| word.trim_matches(['"', '\'']).trim().to_string()).collect()
}

/// Whether a field is a number; an empty field counts as one.
pub(super) fn is_number(field: &str, delimiter: Option<u8>) -> bool {
    let decimal = || delimiter != Some(b',') && number_with_comma(field.as_bytes()).is_some();
    field.is_empty() || parse_number(field.as_bytes()).is_some() || decimal()
}

/// Parses a number with a decimal comma.
pub(super) fn number_with_comma(field: &[u8]) -> Option<f64> {
    let comma = field.iter().position(|b| *b == b',')?;
    let mut field = field.to_vec();
    *field.get_mut(comma)? = b'.';
    parse_number(&field)
}

/// Finds a column of positions whose fields are whole vectors such as `"(1, 2, 3)"`. Returns its name; `None` if
/// there is none, or if the heading has names of positions.
pub(super) fn in_a_cell(lines: &[Line], heading: &Heading) -> Option<String> {
    if have_positions(&heading.names) {
        return None;
    }
    let mut rows = lines.iter().filter(|line| !is_comment(&line.text));
    let (names, row) = (rows.next()?, rows.next()?);
    let separator = delimiter(&names.text);
    let (names, row) = (fields(&names.text, separator), fields(&row.text, separator));
    let vector =
        |field: &str| field.starts_with(['(', '[', '{']) && field.contains(char::is_numeric);
    let mut all = names.into_iter().zip(row);
    all.find(|(name, field)| is_position(name) && vector(field)).map(|(name, _)| name)
}

/// Finds a line of units, or a rule, between the names and the rows. Such a line is the first one from index
/// `from` on (comments do not count) if it has no numbers, but the next line has. Returns its index, and that
/// line of numbers.
fn below(lines: &[Line], from: usize) -> Option<(usize, &Line)> {
    let mut all = lines.iter().enumerate().skip(from).filter(|(_, line)| !is_between(&line.text));
    let ((at, units), (_, row)) = (all.next()?, all.next()?);
    let separator = delimiter(&row.text);
    let number = |field: &String| !field.is_empty() && is_number(field, separator);
    let [units, row] = [units, row].map(|line| (fields(&line.text, separator), line));
    (!units.0.iter().any(number) && units.0.len() <= row.0.len() && row.0.iter().any(number))
        .then_some((at, row.1))
}

/// Units of length that files have in brackets behind the names of columns (`x [mm]`) or in a row below the names:
/// for each unit its name, and metres per unit. A row below the names holds units if at least one of its words is the
/// name of such a unit.
pub const LENGTH_UNITS: [(&str, f64); 12] = [
    ("m", 1.0),
    ("metre", 1.0),
    ("mm", 1.0e-3),
    ("cm", 1.0e-2),
    ("dm", 0.1),
    ("km", 1.0e3),
    ("um", 1.0e-6),
    ("\u{b5}m", 1.0e-6),
    ("\u{3bc}m", 1.0e-6),
    ("nm", 1.0e-9),
    ("in", 0.0254),
    ("ft", 0.3048),
];

/// If a line below the names holds units, puts each in brackets behind its name: `x [mm]`, as other files have it.
fn add_units(names: &mut [String], line: &[u8], separator: Option<u8>) {
    // Without a separator, brackets in a row would count as one field.
    let words = match separator {
        Some(_) => fields(line, separator),
        None => String::from_utf8_lossy(line).split_whitespace().map(String::from).collect(),
    };
    let bare = |word: &String| {
        let word = word.trim_matches(['"', '\'']).trim();
        let inner = word.strip_prefix(['[', '(']).and_then(|word| word.strip_suffix([']', ')']));
        inner.unwrap_or(word).trim().to_string()
    };
    let units: Vec<String> = words.iter().map(bare).collect();
    // Blank units between spaces cannot be seen, so that the others could belong to any name.
    let fits = match separator {
        Some(_) => units.len() <= names.len(),
        None => units.len() == names.len(),
    };
    let is_length = |unit: &String| LENGTH_UNITS.iter().any(|(name, _)| name == unit);
    if !fits || !units.iter().any(is_length) {
        return;
    }
    for (name, unit) in names.iter_mut().zip(units) {
        // `[1]` and `[-]` are no units, and `[1]` would be a component.
        let unitless = !unit.contains(char::is_alphabetic) || is_suffix(&unit);
        if !unitless && !name.contains(['[', '(']) {
            *name = format!("{name} [{unit}]");
        }
    }
}

/// A line of names without a title such as `columns:` before them.
fn behind_title(line: &[u8]) -> &[u8] {
    const TITLES: [&[u8]; 7] =
        [b"columns", b"column names", b"fields", b"variables", b"names", b"format", b"data"];
    let title = line.iter().position(|b| matches!(b, b':' | b'='));
    let Some((title, rest)) = title.and_then(|at| line.split_at_checked(at)) else { return line };
    let is = |name: &&[u8]| title.trim_ascii().eq_ignore_ascii_case(name);
    if TITLES.iter().any(is) { rest.get(1..).unwrap_or_default().trim_ascii() } else { line }
}

/// Warning that names are not used because there are not as many as columns.
fn misfit_warning(names: &[String], columns: usize) -> String {
    let some: Vec<_> = names.iter().take(12).map(String::as_str).collect();
    let more = if names.len() > some.len() { " ..." } else { "" };
    format!(
        "a comment names {} columns ({}{more}), but the rows have {columns}: the names are not used; name all columns \
         in one line above the rows, such as # x y z vx vy vz",
        names.len(),
        some.join(" ")
    )
}

impl Heading {
    pub(super) fn of(lines: &[Line]) -> Self {
        let passed = |upto: usize| {
            lines.iter().take(upto).filter(|line| !is_comment(&line.text)).count() as u64
        };
        let data = |after: usize| lines.iter().skip(after).find(|line| !is_between(&line.text));
        let (mut list, mut misfit) = (numbered::List::default(), None);
        for (i, line) in lines.iter().enumerate() {
            let (names_line, marked) = uncommented(&line.text);
            let names_line = tecplot::variables(names_line).unwrap_or(names_line);
            let commented = std::str::from_utf8(names_line).ok().filter(|_| marked);
            let of_list = commented.and_then(|line| list.add(line).map(<[String]>::to_vec));
            let of_line = commented.and_then(numbered::names);
            let names_line = if marked { behind_title(names_line) } else { names_line };
            // Units, or a rule, may be between the names and the rows.
            let below = below(lines, i + 1);
            let row = below.map_or_else(|| data(i + 1), |(_, row)| Some(row));
            let separator = row.map_or_else(|| delimiter(names_line), |row| delimiter(&row.text));
            // The last fields of the row may be empty, or a separator may end it.
            let count = row.map(|row| {
                let count = fields(&row.text, separator).len();
                let ends =
                    separator.map_or(0, |d| row.text.iter().filter(|b| **b == d).count() + 1);
                count..=ends.max(count)
            });
            let mut separators = vec![separator];
            separators.extend([b';', b'\t', b'|', b','].map(Some));
            separators.push(None);
            let fits = |names: &Vec<String>| {
                count.as_ref().is_none_or(|count| count.contains(&names.len()))
            };
            // Numbered names of all columns are names even if none of them is a position.
            let with_numbers = of_line.or(of_list);
            let named = with_numbers.clone().filter(|names| {
                count.is_some() && fits(names) && (names.len() > 2 || have_positions(names))
            });
            let all = || separators.iter().map(|d| fields(names_line, *d));
            let names = named.or_else(|| {
                all().filter(|_| with_numbers.is_none()).find(|names| {
                    let words = names.iter().any(|name| !is_number(name, None));
                    words && fits(names) && have_positions(names)
                })
            });
            let near = || lines.iter().skip(i + 1).take(NEAR).any(|line| !is_comment(&line.text));
            if let (None, Some(_), Some(count)) = (&names, commented, &count)
                && near()
            {
                let known = |names: &Vec<String>| {
                    let known = |name: &&String| names::known(&names::plain(name));
                    names.len() > 1
                        && 2 * names.iter().filter(known).count() > names.len()
                        && have_positions(names)
                };
                let unfit = with_numbers.into_iter().chain(all()).find(known);
                misfit = unfit.map(|names| misfit_warning(&names, *count.end())).or(misfit);
            }
            if let Some(mut names) = names {
                let next = lines.get(i + 1).map(|line| uncommented(&line.text).0);
                next.into_iter().for_each(|line| add_units(&mut names, line, separator));
                let passed = passed(i);
                let text = uncommented(&line.text).0.to_vec();
                let (i, line) =
                    below.map_or((i, line), |(units, _)| (units, lines.get(units).unwrap_or(line)));
                let (at, line) = (line.next, i as u64 + 1);
                return Self { delimiter: separator, names, at, line, passed, text, misfit: None };
            }
            if i > 0 && !is_comment(&line.text) && row.is_none() {
                break;
            }
        }
        Self { misfit, ..Self::unnamed(lines, passed) }
    }

    /// The heading of a table without names of positions.
    fn unnamed(lines: &[Line], passed: impl Fn(usize) -> u64) -> Self {
        let numbers = |line: &Line| {
            let separator = delimiter(&line.text);
            let fields = fields(&line.text, separator);
            let all = fields.iter().all(|field| is_number(field, separator));
            (separator, all, fields)
        };
        let mut before: Option<Vec<String>> = None;
        for (i, line) in lines.iter().enumerate() {
            if is_comment(&line.text) {
                continue;
            }
            let (separator, all, fields) = numbers(line);
            if all && fields.len() >= 2 {
                // Names are used even if none of them is a position.
                let names = before.filter(|names| names.len() == fields.len());
                return Self {
                    delimiter: separator,
                    names: names.unwrap_or_default(),
                    at: line.start,
                    line: i as u64,
                    passed: passed(i),
                    text: Vec::new(),
                    misfit: None,
                };
            }
            before = Some(fields);
        }
        let first = lines.iter().position(|line| !is_comment(&line.text));
        let line = first.and_then(|i| lines.get(i));
        Self {
            delimiter: line.and_then(|line| delimiter(&line.text)),
            names: Vec::new(),
            at: line.map_or_else(|| lines.last().map_or(0, |line| line.next), |line| line.start),
            line: first.unwrap_or(lines.len()) as u64,
            passed: 0,
            text: Vec::new(),
            misfit: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_split_as_csv() {
        for line in [
            "x,y,z",
            " Pos.x [m] ,\tvx , ",
            "1,,2,,",
            "",
            " , ,",
            "#x,y",
            "\u{a0}x\u{a0},y",
            "'a,b',c",
            "a;b,c|d",
            "\"a,b\", c",
            "a,\"b\"\"c\"",
            "a,b\rc,d",
        ] {
            for delimiter in [b',', b';', b'|', b'\t'] {
                let mut expected = quoted(line.as_bytes(), delimiter);
                while expected.last().is_some_and(String::is_empty) {
                    expected.pop();
                }
                assert_eq!(fields(line.as_bytes(), Some(delimiter)), expected, "{line}");
            }
        }
    }
}
