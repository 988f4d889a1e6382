//! Strands in PLY, as tools write them: the format has no standard for strands.
//!
//! Nodes are the rows of `vertex`: `x y z`, and `radius`, or a diameter as `thickness` or `width`.
//! The first of the following that a file has joins them:
//!
//! 1. a table with a count per strand, as hairutil's `strand` with `nsegs`; nodes then stand in order;
//! 2. a table of lists of vertices, such as `strand`, `line` or `polyline`;
//! 3. a table of pairs of vertices, `edge` with `vertex1 vertex2`; chains begin at the end of the lower number;
//! 4. a column of `vertex` that numbers strands, such as `strand_id`.

use super::bytes::{Bytes, position};
use super::ply::{Element, Ply, Row};
use super::raw::{Raw, RawStrand};
use super::{Problem, Wrong};
use glam::Vec3;

/// Columns that count the segments of a strand; [`NODES`] counts its nodes.
const SEGMENTS: [&str; 4] = ["nsegs", "segments", "num_segments", "segment_count"];
const NODES: [&str; 9] = [
    "nverts",
    "npoints",
    "num_vertices",
    "num_points",
    "vertex_count",
    "point_count",
    "length",
    "count",
    "vertices",
];
/// Columns that hold lists of vertices.
const LISTS: [&str; 6] = [
    "vertex_indices",
    "vertex_index",
    "indices",
    "vertices",
    "points",
    "point_indices",
];
/// Columns that hold the two vertices of an edge.
const PAIRS: [[&str; 2]; 4] = [
    ["vertex1", "vertex2"],
    ["v1", "v2"],
    ["vertex_1", "vertex_2"],
    ["start", "end"],
];
/// Columns of `vertex` that number strands.
const IDS: [&str; 6] = [
    "strand_id",
    "curve_id",
    "hair_id",
    "strand",
    "curve",
    "strand_index",
];

/// Rule that joins nodes to strands.
#[derive(Clone, Copy)]
enum Join {
    /// Nodes in order; a column has their number, less this one.
    Counts(usize, u32),
    Lists(usize),
    Pairs([usize; 2]),
    Ids(usize),
}

/// Returns the index of the table that joins nodes, with the rule.
fn join(ply: &Ply<'_>) -> Option<(usize, Join)> {
    let vertex = |element: &Element| element.name == "vertex";
    let beside = || {
        ply.elements
            .iter()
            .enumerate()
            .filter(|(_, one)| !vertex(one))
    };
    let counts = beside().find_map(|(place, one)| {
        let segments = one
            .column(&SEGMENTS, false)
            .map(|column| Join::Counts(column, 1));
        let nodes = || {
            one.column(&NODES, false)
                .map(|column| Join::Counts(column, 0))
        };
        Some((place, segments.or_else(nodes)?))
    });
    let lists = || {
        let mut lines = beside().filter(|(_, one)| one.name != "face");
        lines.find_map(|(place, one)| Some((place, Join::Lists(one.column(&LISTS, true)?))))
    };
    let pairs = || {
        beside().find_map(|(place, one)| {
            let pair = PAIRS
                .iter()
                .find_map(|[a, b]| Some([one.column(&[a], false)?, one.column(&[b], false)?]));
            Some((place, Join::Pairs(pair?)))
        })
    };
    let ids = || {
        let mut vertices = ply
            .elements
            .iter()
            .enumerate()
            .filter(|(_, one)| vertex(one));
        vertices.find_map(|(place, one)| Some((place, Join::Ids(one.column(&IDS, false)?))))
    };
    counts.or_else(lists).or_else(pairs).or_else(ids)
}

/// Columns of the position and the radius of nodes.
pub(super) struct Vertices {
    place: [usize; 3],
    radius: Option<(usize, f32)>,
}

impl Vertices {
    pub(super) fn new<'a>(ply: &'a Ply<'_>) -> Result<(&'a Element, Self), Wrong> {
        let missing = || {
            let problem = "the header must have an element `vertex` with x, y and z";
            (0, Problem::Text(problem.to_owned()))
        };
        let mut elements = ply.elements.iter();
        let vertex = elements
            .find(|one| one.name == "vertex")
            .ok_or_else(missing)?;
        let column = |name| vertex.column(&[name], false).ok_or_else(missing);
        let radius = vertex
            .column(&["radius", "r"], false)
            .map(|column| (column, 1.0));
        let width = || vertex.column(&["thickness", "width", "diameter"], false);
        let columns = Self {
            place: [column("x")?, column("y")?, column("z")?],
            radius: radius.or_else(|| width().map(|column| (column, 0.5))),
        };
        Ok((vertex, columns))
    }

    /// Reads the position of a vertex.
    pub(super) fn place(&self, row: &Row) -> Result<Vec3, Wrong> {
        #[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
        let place = Vec3::from(self.place.map(|column| row.number(column) as f32));
        position(place, row.offset)
    }
}

/// Checks the file and returns its strands, with radii only if they are wanted.
pub(super) fn parse(bytes: Bytes<'_>, wants_radii: bool) -> Result<Raw<'_>, Wrong> {
    let ply = Ply::new(bytes)?;
    let (vertex, mut columns) = Vertices::new(&ply)?;
    if !wants_radii {
        columns.radius = None;
    }
    let Some((table, join)) = join(&ply) else {
        let names: Vec<&str> = ply.elements.iter().map(|one| one.name.as_str()).collect();
        let hint = if names.contains(&"face") {
            "; a mesh is for --head"
        } else {
            ""
        };
        let problem = format!(
            "strands must have a count, a list of vertices or edges each, got elements {}{hint}",
            names.join(", ")
        );
        return Err((0, Problem::Text(problem)));
    };
    let limit = vertex.count;
    let mut nodes: Vec<(Vec3, f32)> = Vec::new();
    let mut radii = None;
    let mut strands = Joined::default();
    let end = ply.rows(|element, row| {
        if core::ptr::eq(element, vertex) {
            let mut radius = 0.0;
            if let Some((column, factor)) = columns.radius {
                #[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
                let value = row.number(column) as f32;
                if !(0.0..=1e6).contains(&value) {
                    return Err((row.offset, Problem::Thickness { value }));
                }
                radius = factor * value;
                radii.get_or_insert(row.offset);
            }
            nodes.push((columns.place(row)?, radius));
        }
        if core::ptr::eq(element, &ply.elements[table]) {
            strands.add(join, row, limit)?;
        }
        Ok(())
    })?;
    let mut remarks: Vec<String> = bytes.remark_behind(end).into_iter().collect();
    let (firsts, order) = strands.finish(limit, &mut remarks)?;
    let count = firsts.len() - 1;
    let used = u64::from(firsts[count]);
    let offset = radii.unwrap_or(0);
    let strand = move |strand: usize| {
        let range = firsts[strand] as usize..firsts[strand + 1] as usize;
        let of_strand: Vec<_> = match &order {
            Some(order) => order[range].iter().map(|&k| nodes[k as usize]).collect(),
            None => nodes[range].to_vec(),
        };
        RawStrand {
            number: strand,
            offset,
            nodes: Box::new(of_strand.into_iter()),
        }
    };
    Ok(Raw {
        scale: 1.0,
        strands: Box::new((0..count).map(strand)),
        count,
        nodes: used,
        radii,
        remarks,
    })
}

/// Strands while they are joined.
#[derive(Default)]
struct Joined {
    /// First node of each strand and the end of the last, in the order of nodes.
    firsts: Vec<u32>,
    /// Order of nodes, if it is not that of the file.
    order: Vec<u32>,
    in_order: bool,
    /// Neighbours of each node, as their number plus one; 0 for none.
    neighbours: Vec<[u32; 2]>,
    id: Option<f64>,
    nodes: u32,
}

impl Joined {
    fn add(&mut self, join: Join, row: &Row, limit: u64) -> Result<(), Wrong> {
        if self.firsts.is_empty() && self.neighbours.is_empty() {
            self.firsts.push(0);
        }
        match join {
            Join::Counts(column, less) => {
                self.in_order = true;
                let count = row.count(row.number(column))?;
                let needed = u64::from(self.nodes) + u64::from(count) + u64::from(less);
                self.nodes = u32::try_from(needed)
                    .ok()
                    .filter(|_| needed <= limit)
                    .ok_or((row.offset, Problem::Points { needed, got: limit }))?;
                self.firsts.push(self.nodes);
            }
            Join::Lists(column) => {
                for value in &row.columns[column] {
                    self.order.push(row.index(*value, limit)?);
                }
                // A vertex may be in several strands, but not in so many that the file grows.
                let nodes = row.index(self.order.len() as f64, 1 << 31)?;
                self.firsts.push(nodes);
            }
            Join::Pairs(columns) => {
                let [a, b] = columns.map(|column| row.index(row.number(column), limit));
                let (a, b) = (a?, b?);
                self.neighbours
                    .resize(usize::try_from(limit).unwrap_or(0), [0; 2]);
                for (from, to) in [(a, b), (b, a)] {
                    let free = self.neighbours[from as usize].iter_mut().find(|k| **k == 0);
                    let Some(free) = free else {
                        let problem = format!("vertex {from} must be of at most two edges");
                        return Err((row.offset, Problem::Text(problem)));
                    };
                    *free = to + 1;
                }
            }
            Join::Ids(column) => {
                self.in_order = true;
                let id = row.number(column);
                if self.id.is_some_and(|last| last != id) {
                    self.firsts.push(self.nodes);
                }
                self.id = Some(id);
                self.nodes += 1;
            }
        }
        Ok(())
    }

    /// Returns the first node of each strand and the end of the last, and the order of nodes if it is not the file's.
    fn finish(
        mut self,
        limit: u64,
        remarks: &mut Vec<String>,
    ) -> Result<(Vec<u32>, Option<Vec<u32>>), Wrong> {
        if self.id.is_some() {
            self.firsts.push(self.nodes);
        }
        if !self.neighbours.is_empty() {
            self.follow_edges();
        }
        if self.firsts.len() < 2 {
            let problem = "there must be a strand".to_owned();
            return Err((0, Problem::Text(problem)));
        }
        let used = self.firsts.last().copied().unwrap_or(0);
        if u64::from(used) < limit {
            if self.in_order {
                let (needed, got) = (u64::from(used), limit);
                return Err((0, Problem::Points { needed, got }));
            }
            remarks.push(format!(
                "{} of {limit} vertices are of no strand",
                limit - u64::from(used)
            ));
        }
        let order = (!self.in_order).then_some(self.order);
        Ok((self.firsts, order))
    }

    /// Follows chains of edges, first from their ends in the order of the ends, then through what is left of closed chains.
    fn follow_edges(&mut self) {
        self.firsts = vec![0];
        let mut seen = vec![false; self.neighbours.len()];
        let ends = |node: &[u32; 2]| node.contains(&0) && *node != [0; 2];
        let open = (0_u32..)
            .zip(&self.neighbours)
            .filter(|(_, node)| ends(node));
        let closed = (0_u32..)
            .zip(&self.neighbours)
            .filter(|(_, node)| !node.contains(&0));
        for (start, _) in open.chain(closed) {
            let mut node = start;
            if seen[node as usize] {
                continue;
            }
            loop {
                seen[node as usize] = true;
                self.order.push(node);
                let next = self.neighbours[node as usize].iter().filter(|&&k| k > 0);
                let mut next = next.map(|k| k - 1).filter(|&k| !seen[k as usize]);
                match next.next() {
                    Some(k) => node = k,
                    None => break,
                }
            }
            #[expect(
                clippy::cast_possible_truncation,
                reason = "vertices are numbered in 32 bits"
            )]
            self.firsts.push(self.order.len() as u32);
        }
    }
}
