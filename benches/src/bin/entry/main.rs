//! Program that runs one entry point at a time, for callgrind and for timing by hand.
//!
//! - `entry list`: prints the names of all entry points on every level of this CPU.
//! - `entry run NAME PASSES`: makes passes over the inputs and nothing else, so that the cost of a pass is the difference between two
//!   runs with different numbers of passes.
//! - `entry time NAME SECONDS`: prints the time per direction in ns, as the median over stretches of a millisecond.
//! - `entry dirty [NAME]`: checks which packets and slices are slowed down by dirty upper halves of the vector registers; fails if any
//!   is.
//! - `entry exceptions`: prints how many calls raise floating-point exceptions, of every entry point and of the set-up; fails if any
//!   does.
//! - `entry keep`: runs nothing, but keeps in the program the functions whose size `.ci/sizes.sh` reports.
//!
//! A name that ends in `*` selects all entry points with that prefix. `run` also prints the number of calls per pass.

mod dirty;
mod exceptions;
mod outlined;

use hairis_benches::{Name, Op, Task, Visitor, entries};
use std::env::args;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let words: Vec<String> = args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let runner = |name, work| Runner {
        name,
        work,
        found: false,
        failed: 0,
    };
    let mut runner = match words[..] {
        ["list"] => runner("*", Work::List),
        ["run", name, passes] if passes.parse::<u32>().is_ok() => {
            runner(name, Work::Run(passes.parse().unwrap_or(0)))
        }
        ["time", name, seconds] if seconds.parse::<f64>().is_ok() => {
            runner(name, Work::Time(seconds.parse().unwrap_or(0.0)))
        }
        ["dirty", ..] if !dirty::can_be() => {
            println!("this CPU has no AVX2: nothing can be dirty");
            return ExitCode::SUCCESS;
        }
        ["dirty"] => runner("*", Work::Dirty),
        ["dirty", name] => runner(name, Work::Dirty),
        ["keep"] => {
            outlined::keep();
            return ExitCode::SUCCESS;
        }
        ["exceptions"] => runner("*", Work::Exceptions),
        _ => {
            eprintln!(
                "usage: entry keep | entry exceptions | entry list | entry dirty [NAME] | entry run NAME PASSES | entry time NAME SECONDS"
            );
            return ExitCode::from(2);
        }
    };
    for op in Op::ALL {
        entries::visit(op, &mut runner);
    }
    if runner.work == Work::Exceptions {
        runner.failed += exceptions::on_one_lane();
        if runner.failed == 0 {
            println!("every entry point, and the set-up: no exceptions");
        }
    }
    if runner.failed > 0 {
        if runner.work == Work::Dirty {
            println!(
                "{} entry points take longer when the upper halves are dirty",
                runner.failed
            );
        }
        return ExitCode::FAILURE;
    }
    if runner.found || runner.work == Work::List {
        return ExitCode::SUCCESS;
    }
    eprintln!("there is no entry point {} on this CPU", runner.name);
    ExitCode::from(2)
}

#[derive(Clone, Copy, PartialEq)]
enum Work {
    List,
    Run(u32),
    Time(f64),
    Dirty,
    Exceptions,
}

struct Runner<'a> {
    name: &'a str,
    work: Work,
    found: bool,
    failed: u32,
}

impl Visitor for Runner<'_> {
    fn wants(&self, name: &Name) -> bool {
        let is_reference = name.entry == "reference";
        let (op, level, name) = (name.op, name.level, name.to_string());
        if self.work == Work::List {
            println!("{name}");
            return false;
        }
        if self.work == Work::Dirty && (matches!(op, Op::Path(_)) || matches!(level, "scalar")) {
            return false;
        }
        // The formulas as a port has them promise nothing.
        if self.work == Work::Exceptions && is_reference {
            return false;
        }
        self.name
            .strip_suffix('*')
            .map_or(name == self.name, |start| name.starts_with(start))
    }

    fn visit<T: Task>(&mut self, name: &Name, mut task: T) {
        self.found = true;
        match self.work {
            Work::List => {}
            Work::Run(passes) => {
                pass(&mut task, passes);
                println!("{name} {} {}", task.calls(), task.directions());
            }
            Work::Time(seconds) => println!("{name} {:.3}", time(&mut task, seconds)),
            Work::Dirty => self.failed += u32::from(!dirty::is_harmless(name, &mut task)),
            Work::Exceptions => self.failed += exceptions::raised_by(name, &mut task),
        }
    }
}

#[inline(never)]
fn pass<T: Task>(task: &mut T, passes: u32) {
    for _ in 0..passes {
        for index in 0..task.calls() {
            task.call(index);
        }
    }
}

/// Returns the time per direction in ns: the median over stretches of at least a millisecond.
fn time<T: Task>(task: &mut T, seconds: f64) -> f64 {
    let mut stretch = |passes: u32| {
        let start = Instant::now();
        pass(task, passes);
        start.elapsed().as_secs_f64()
    };
    let once = (0..5)
        .map(|_| stretch(1))
        .fold(f64::INFINITY, f64::min)
        .max(1e-9);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 1 to a thousand"
    )]
    let passes = (1e-3 / once).ceil().clamp(1.0, 1e3) as u32;
    let start = Instant::now();
    let mut stretches = Vec::new();
    while stretches.is_empty() || start.elapsed().as_secs_f64() < seconds {
        stretches.push(stretch(passes));
    }
    stretches.sort_by(f64::total_cmp);
    let median = stretches[stretches.len() / 2];
    #[expect(clippy::cast_precision_loss, reason = "some thousand")]
    let directions = (task.calls() * task.directions()) as f64;
    median * 1e9 / (f64::from(passes) * directions)
}
