//! The table of roads.

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use super::{
    kind::{Kind, Recordings},
    road::{Cell, Road},
};

/// The cells that were tried, by row and column.
pub struct Table {
    cells: BTreeMap<(usize, usize), Cell>,
    /// Those that are neither right nor refused.
    pub wrong: Vec<String>,
}

impl Table {
    /// Tries these cells, on all cores.
    pub fn of(recordings: &Recordings, tried: &[(usize, usize)]) -> Self {
        let results = Mutex::new(BTreeMap::new());
        let next = AtomicUsize::new(0);
        let threads = thread::available_parallelism().map_or(2, usize::from);
        thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    while let Some(&(row, column)) = tried.get(next.fetch_add(1, Ordering::Relaxed))
                    {
                        let (kind, road) = (Kind::ALL[row], Road::ALL[column]);
                        let place = recordings.folder.join(format!("{kind:?}-{road:?}"));
                        fs::create_dir_all(&place).unwrap();
                        let result = road.go(&recordings.path(kind), kind.shown(), &place);
                        if result.is_ok() {
                            fs::remove_dir_all(&place).unwrap();
                        }
                        results.lock().unwrap().insert((row, column), result);
                    }
                });
            }
        });
        let mut table = Self {
            cells: BTreeMap::new(),
            wrong: Vec::new(),
        };
        for ((row, column), result) in results.into_inner().unwrap() {
            match result {
                Ok(cell) => drop(table.cells.insert((row, column), cell)),
                Err(wrong) => table.wrong.push(format!(
                    "{}, {}: {wrong}",
                    Kind::ALL[row].name(),
                    Road::ALL[column].name()
                )),
            }
        }
        table
    }

    /// The page of docs. All cells have been tried.
    pub fn page(&self) -> String {
        let mut page = "# Roads\n\n\
            Everything that makes a recording, and everything that reads one. Written by `TABLETOP_ROADS=all cargo test --release --test roads`, \
            which goes every road and compares the result with what each recording is known to show; a cell is right (✓) or refused with a \
            sentence. Commands and kinds of recordings that are not in the table do not pass the test.\n"
            .to_owned();
        for (row, kind) in Kind::ALL.iter().enumerate() {
            let _never = write!(page, "\n## {}\n\n", kind.name());
            for line in self.lines(row) {
                page += &line;
                page.push('\n');
            }
        }
        page
    }

    /// The lines of a kind: the roads that are right, and each refusal.
    fn lines(&self, row: usize) -> Vec<String> {
        let cells = self.cells.range((row, 0)..(row + 1, 0));
        cells
            .map(|((_, column), cell)| line_of(Road::ALL[*column], cell))
            .collect()
    }

    /// The cells that the page has otherwise.
    pub fn differing(&self, page: &str) -> Vec<String> {
        let mut sections = BTreeMap::new();
        for section in page.split("\n## ").skip(1) {
            let (name, text) = section.split_once('\n').unwrap_or((section, ""));
            sections.insert(name, text);
        }
        let mut differing = Vec::new();
        for (row, kind) in Kind::ALL.iter().enumerate() {
            let section = sections.get(kind.name()).copied().unwrap_or_default();
            for line in self.lines(row) {
                if !section.lines().any(|known| known == line) {
                    differing.push(format!("{}: {line}", kind.name()));
                }
            }
        }
        differing
    }
}

fn line_of(road: Road, cell: &Cell) -> String {
    match cell {
        Cell::Right => format!("- ✓ `{}`", road.name()),
        Cell::Refused(sentence) => format!("- `{}` is refused: {sentence}", road.name()),
    }
}
