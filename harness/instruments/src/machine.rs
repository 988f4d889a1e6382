//! Machine and build that produced a report, printed beside its figures.

use serde::Serialize;

/// Machine and build, as reported by the system and the compiler; nothing is measured. Made by the macro [`machine!`](crate::machine!).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Model name of the processor, or its architecture if the system does not report the name.
    pub cpu: String,
    /// Number of logical cores that this process may use.
    pub logical_cores: usize,
    /// Operating system, as Rust names it.
    pub os: &'static str,
    /// Architecture, as Rust names it.
    pub arch: &'static str,
    /// Version line of the compiler.
    pub rustc: &'static str,
    /// Optimisation level of the package that called [`machine!`](crate::machine!).
    pub opt_level: &'static str,
    /// Whether debug assertions are compiled in, in which case figures of speed mean nothing.
    pub debug_assertions: bool,
    /// Full hash of the commit that the build was made from, or "unknown".
    pub commit: &'static str,
    /// Whether tracked files differed from the commit when the build was made; `None` if unknown.
    ///
    /// The build script checks again after each commit and each change of a source that it watches. Until then, an edit of other files
    /// goes unnoticed.
    pub dirty: Option<bool>,
    /// Target features that the code was compiled for, limited to those that may affect the kernels. Dispatch at run time may use more.
    pub target_features: Vec<&'static str>,
}

/// Returns the current [`Machine`](crate::machine::Machine) with the build of the calling package. The build script of that package
/// must set the variables `HAIRIS_BUILD_*`, as `harness/build.rs` does.
#[macro_export]
macro_rules! machine {
    () => {
        $crate::machine::Machine::of_build([
            env!("HAIRIS_BUILD_COMMIT"),
            env!("HAIRIS_BUILD_DIRTY"),
            env!("HAIRIS_BUILD_RUSTC"),
            env!("HAIRIS_BUILD_OPT_LEVEL"),
            env!("HAIRIS_BUILD_TARGET_FEATURES"),
        ])
    };
}

impl Machine {
    /// Describes this machine and the facts that a build script recorded: the commit, whether files differ from the commit ("yes", "no"
    /// or "unknown"), the compiler, the optimisation level, and the target features separated by commas.
    #[must_use]
    pub fn of_build([commit, dirty, rustc, opt_level, target_features]: [&'static str; 5]) -> Self {
        Self {
            cpu: cpu_name(),
            logical_cores: std::thread::available_parallelism().map_or(1, usize::from),
            os: std::env::consts::OS,
            arch: std::env::consts::ARCH,
            rustc,
            opt_level,
            debug_assertions: cfg!(debug_assertions),
            commit,
            dirty: match dirty {
                "yes" => Some(true),
                "no" => Some(false),
                _ => None,
            },
            target_features: known_features(target_features),
        }
    }

    /// Returns processor and cores for a sentence, with a warning if the build is not optimised.
    #[must_use]
    pub fn in_words(&self) -> String {
        let warning = if self.debug_assertions {
            "; a build with debug assertions, whose times mean nothing"
        } else {
            ""
        };
        format!(
            "{}, {} logical cores{warning}",
            self.cpu, self.logical_cores
        )
    }

    /// Returns one line for the captions of tables: processor, cores, system, compiled features, compiler and commit.
    #[must_use]
    pub fn summary(&self) -> String {
        let commit = self.commit.get(..12).unwrap_or(self.commit);
        let dirty = if self.dirty == Some(true) {
            "+changes"
        } else {
            ""
        };
        let features = if self.target_features.is_empty() {
            "baseline".to_owned()
        } else {
            self.target_features.join("+")
        };
        format!(
            "{}, {} logical cores, {} {}, compiled for {features}, {}, commit {commit}{dirty}",
            self.cpu, self.logical_cores, self.os, self.arch, self.rustc
        )
    }
}

/// Returns the processor's name as the system reports it, or the architecture.
fn cpu_name() -> String {
    std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| name_in_cpuinfo(&text))
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// Returns the first name in a `cpuinfo` text: "model name" on x86, other keys on ARM, POWER and RISC-V.
#[must_use]
pub fn name_in_cpuinfo(text: &str) -> Option<String> {
    [
        "model name",
        "Model",
        "Hardware",
        "cpu",
        "uarch",
        "Processor",
    ]
    .iter()
    .find_map(|key| {
        text.lines().find_map(|line| {
            let (name, value) = line.split_once(':')?;
            let value = value.split_whitespace().collect::<Vec<_>>().join(" ");
            (name.trim() == *key && !value.is_empty()).then_some(value)
        })
    })
}

/// Returns the compiled target features that may affect the speed of the kernels.
fn known_features(compiled: &'static str) -> Vec<&'static str> {
    const KNOWN: [&str; 12] = [
        "sse2", "sse4.1", "sse4.2", "avx", "avx2", "fma", "bmi2", "avx512f", "avx512vl", "neon",
        "sve", "simd128",
    ];
    let compiled: Vec<&str> = compiled.split(',').collect();
    KNOWN
        .into_iter()
        .filter(|name| compiled.contains(name))
        .collect()
}
