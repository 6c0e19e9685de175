//! Relative links of the Markdown files lead to files and headings that exist.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Markdown files of the root, of `docs` and of the folders of `assets` and `research`.
fn pages() -> HashMap<PathBuf, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).canonicalize().unwrap();
    let mut pages = HashMap::new();
    for pattern in ["*.md", "docs/*.md", "assets/*/*.md", "research/*/*.md"] {
        let mut folders = vec![root.clone()];
        let (path, _) = pattern.rsplit_once('/').unwrap_or(("", pattern));
        for name in path.split('/').filter(|name| !name.is_empty()) {
            let inside = |folder: PathBuf| match name {
                "*" => entries(&folder).into_iter().filter(|path| path.is_dir()).collect(),
                _ => vec![folder.join(name)],
            };
            folders = folders.into_iter().flat_map(inside).collect();
        }
        for file in folders.iter().flat_map(|folder| entries(folder)) {
            if file.extension().is_some_and(|ext| ext == "md") {
                pages.insert(file.clone(), std::fs::read_to_string(&file).unwrap());
            }
        }
    }
    pages
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

/// Text outside fenced code.
fn prose(page: &str) -> impl Iterator<Item = &str> {
    page.split("```").step_by(2)
}

/// Anchors of the headings by GitHub's rule: lower case, spaces become hyphens, punctuation is removed.
fn anchors(page: &str) -> Vec<String> {
    let headings = prose(page).flat_map(str::lines).filter_map(|line| line.strip_prefix('#'));
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let anchor = |heading: &str| heading.trim_start_matches('#').trim().to_lowercase();
    headings.map(|h| anchor(h).chars().filter(kept).collect::<String>().replace(' ', "-")).collect()
}

/// Targets of the links `[text](target)`.
fn targets(page: &str) -> Vec<&str> {
    let ends = |rest: &'_ str| rest.find([')', ' ']).unwrap_or(rest.len());
    let links = prose(page).flat_map(|part| part.split("](").skip(1));
    links.map(|rest| &rest[..ends(rest)]).collect()
}

/// Links of a page that lead nowhere.
fn broken(path: &Path, page: &str, pages: &HashMap<PathBuf, String>) -> Vec<String> {
    let leads = |target: &str| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let there = path.parent().unwrap().join(file).canonicalize();
        let other = match file {
            "" => Some(page),
            _ => match there {
                Ok(there) => pages.get(&there).map(String::as_str),
                Err(_) => return false,
            },
        };
        anchor.is_empty() || other.is_none_or(|page| anchors(page).iter().any(|a| a == anchor))
    };
    let relative = targets(page).into_iter().filter(|target| !target.contains(':'));
    relative.filter(|target| !leads(target)).map(str::to_owned).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    let pages = pages();
    assert!(pages.len() > 10, "{} pages", pages.len());
    let mut links = 0;
    for (path, page) in &pages {
        links += targets(page).len();
        let broken = broken(path, page, &pages);
        assert!(broken.is_empty(), "{}: {broken:?}", path.display());
    }
    assert!(links > 50, "{links} links");
    // Faults are seen.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/whitewater.md");
    let page =
        "# A b\n[1](none.md) [2](differences.md#none) [3](#a-b) [4](#none)\n```\n[5](none)\n```";
    assert_eq!(broken(&path, page, &pages), ["none.md", "differences.md#none", "#none"]);
}
