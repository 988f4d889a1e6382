//! Order of the operations of a derivative, which compilers keep in such long functions.

use hairis::simd::trace::Op;
use hairis_shaders::{Function, Graph, Kind};

/// Numbers that wait before those come first that let fewer wait: of 16 registers, some hold operands.
const REGISTERS: usize = 12;
/// Operations that begin in one cycle.
const WIDTH: u32 = 2;

/// Operations that these rows need: of those whose operands are ready, the one from which the longest chain of operations leads to a
/// row comes first. A CPU looks a few hundred operations ahead for work while it waits for a result.
///
/// Orders that only let few numbers wait, or that of the model, take up to half as long again.
pub(crate) fn order(gradient: &Function, rows: &[u32]) -> Vec<u32> {
    let graph = gradient.graph();
    let places = needed(graph, rows);
    let mut chains = vec![0; graph.nodes().len()];
    let mut readers = vec![Vec::new(); chains.len()];
    let mut missing = vec![0; chains.len()];
    for place in places.iter().rev() {
        chains[*place as usize] += latency(graph.node(*place).kind);
        for operand in operands(graph, *place) {
            chains[operand as usize] = chains[operand as usize].max(chains[*place as usize]);
            readers[operand as usize].push(*place);
            missing[*place as usize] += 1;
        }
    }
    let is_ready = |place: &u32| missing[*place as usize] == 0;
    let mut ready: Vec<u32> = places.iter().copied().filter(is_ready).collect();
    let mut unread: Vec<usize> = readers.iter().map(Vec::len).collect();
    let mut done_at = vec![0; chains.len()];
    let mut order = Vec::with_capacity(places.len());
    let (mut waiting, mut now, mut begun) = (0, 0, 0);
    loop {
        let starts = |place: u32| {
            let operands = operands(graph, place).into_iter();
            operands
                .map(|operand| done_at[operand as usize])
                .max()
                .unwrap_or(0)
        };
        let key = |place: u32| {
            let operands = operands(graph, place).into_iter();
            let last = operands
                .filter(|operand| unread[*operand as usize] == 1)
                .count();
            let kept = usize::from(!readers[place as usize].is_empty());
            let (freed, delay) = (
                last + 1 - kept,
                u32::MAX - u32::saturating_sub(starts(place), now),
            );
            let chain = chains[place as usize];
            if waiting < REGISTERS {
                (0, delay, chain, freed, u32::MAX - place)
            } else {
                (freed, delay, chain, 0, u32::MAX - place)
            }
        };
        let Some(index) = (0..ready.len()).max_by_key(|index| key(ready[*index])) else {
            return order;
        };
        let place = ready[index];
        let start = starts(place).max(now);
        ready.swap_remove(index);
        order.push(place);
        done_at[place as usize] = start + latency(graph.node(place).kind);
        begun += 1;
        now = start + begun / WIDTH;
        begun %= WIDTH;
        for operand in operands(graph, place) {
            unread[operand as usize] -= 1;
            waiting -= usize::from(unread[operand as usize] == 0);
        }
        waiting += usize::from(!readers[place as usize].is_empty());
        for reader in &readers[place as usize] {
            missing[*reader as usize] -= 1;
            if missing[*reader as usize] == 0 {
                ready.push(*reader);
            }
        }
    }
}

/// Operations that these rows need, in the order of the graph.
fn needed(graph: &Graph, rows: &[u32]) -> Vec<u32> {
    let places = (0_u32..).zip(graph.nodes()).zip(graph.needed(rows));
    let places = places.filter(|((_, node), is_needed)| *is_needed && node.is_computed());
    places.map(|((place, _), _)| place).collect()
}

/// Operands that are computed, each once.
fn operands(graph: &Graph, place: u32) -> Vec<u32> {
    let mut operands = graph.node(place).operands().to_vec();
    operands.sort_unstable();
    operands.dedup();
    operands.retain(|operand| graph.node(*operand).is_computed());
    operands
}

/// Cycles until the result, of AMD Zen 4 and much alike elsewhere.
fn latency(kind: Kind) -> u32 {
    match kind {
        Kind::Op(Op::Add | Op::Sub | Op::Mul | Op::Exponent | Op::Mantissa) => 3,
        Kind::Op(Op::MulAdd) => 4,
        Kind::Op(Op::Div) => 11,
        Kind::Op(Op::Sqrt) => 15,
        _ => 1,
    }
}
