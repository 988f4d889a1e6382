//! Finished measurements as files, so that a run that was stopped can continue.

use crate::film::{Crop, Film, Picture};
use crate::part::{Log, Part, Reader, build, digest, seal, unseal};
use crate::protocol::{Errors, Reference, Runs};
use crate::saver::Saver;
use crate::scene::Scene;
use crate::transport::{Integrator, Settings};
use core::cell::{Cell, RefCell};
use core::time::Duration;
use hairis_instruments::error::Error;
use hairis_instruments::files::whole;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::say;
use hairis_instruments::stats::Estimate;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Beginning of the first line of a file, without the number of the format.
const FORMAT: &str = "hairis-render measurement ";
/// First line of a file, with the number of the format.
const MAGIC: &str = "hairis-render measurement 2";

/// Samples per pixel and pass at shading points. Each pass finds its points again, which takes next
/// to no time beside so many samples.
const GATHER_PASS: u32 = 1024;
/// Samples per pixel and pass of paths.
const PATH_PASS: u32 = 64;
/// Time of rendering above which a picture is kept while the others of its measurement are rendered.
const MOMENT: Duration = Duration::from_millis(300);

/// Folder of finished measurements.
///
/// The name of a file has a digest of everything that the measurement depends on, and the second line of the file spells that out.
/// A run with other settings, another seed or another build therefore has other files.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    build: String,
    interrupt: Interrupt,
    /// Files that this run has written or read.
    used: RefCell<BTreeSet<PathBuf>>,
    resumed: Cell<usize>,
}

impl Store {
    /// Opens the folder of measurements for the report in `out`, for a run that `interrupt` may end.
    ///
    /// # Errors
    ///
    /// Returns an error if the folder cannot be made or read, or if it holds measurements in another format.
    pub fn new(out: &Path, interrupt: Interrupt) -> Result<Self, Error> {
        let folder = out.join("unfinished");
        let refuse = |source| Error::Output {
            path: folder.clone(),
            source,
        };
        fs::create_dir_all(&folder).map_err(refuse)?;
        for entry in fs::read_dir(&folder).map_err(refuse)? {
            check_format(&entry.map_err(refuse)?.path())?;
        }
        Ok(Self {
            folder,
            build: build(),
            interrupt,
            used: RefCell::default(),
            resumed: Cell::new(0),
        })
    }

    /// Sets the build whose measurements the run uses, in place of that of this program.
    #[must_use]
    pub fn with_build(self, build: String) -> Self {
        Self { build, ..self }
    }

    /// Returns a measurement, which is read if an earlier run has finished it, and is otherwise made and written. `settings` is a line
    /// of everything that the measurement depends on.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be written, or the error of `measure`.
    pub fn get(
        &self,
        name: &str,
        settings: &str,
        measure: impl FnOnce(&Films<'_>) -> Result<Runs, Error>,
    ) -> Result<Runs, Error> {
        let key = format!("{settings} {}", self.build);
        let stem = format!("{name}-{:016x}", digest(key.as_bytes()));
        let path = self.folder.join(format!("{stem}.part"));
        let is_new = self.used.borrow_mut().insert(path.clone());
        if let Some(found) = read(&path, &key) {
            self.resumed.set(self.resumed.get() + usize::from(is_new));
            return Ok(found);
        }
        let films = Films {
            store: self,
            stem,
            key: &key,
            paths: RefCell::default(),
        };
        let measured = measure(&films)?;
        let bytes = bytes(&measured, &key);
        whole(&path, |out| out.write_all(&bytes))?;
        for path in films.paths.into_inner() {
            // Ignore errors: quick pictures have left no file.
            let _ = fs::remove_file(path);
        }
        Ok(measured)
    }

    /// Returns a reference of two halves of `samples` samples per pixel each. `of_scene` is a line of everything that the reference
    /// depends on, except the settings and the samples.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`get`](Self::get).
    pub fn reference(
        &self,
        name: &str,
        of_scene: &str,
        scene: &Scene,
        settings: &Settings,
        samples: u32,
    ) -> Result<Reference, Error> {
        let half = |half: u64| {
            let of_half = format!("{of_scene} samples={samples} half={half} {settings:?}");
            self.get(&format!("{name}-reference-{half}"), &of_half, |films| {
                Runs::half(settings, samples, half, |settings, picture| {
                    films.render(scene, settings, samples, picture)
                })
            })
        };
        let (a, b) = (half(0)?, half(1)?);
        Ok(Reference::new(&a.picture, &b.picture).with_seconds(a.seconds + b.seconds))
    }

    /// Returns the folder of the files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the count of measurements that an earlier run has left.
    pub fn resumed(&self) -> usize {
        self.resumed.get()
    }

    /// Removes the files of this run, whose report is complete.
    pub fn remove(self) {
        for path in self.used.into_inner() {
            // Ignore errors: a file that is gone need not be removed.
            let _ = fs::remove_file(path);
        }
        // The folder stays if runs with other settings have left files.
        let _ = fs::remove_dir(self.folder);
    }
}

/// Pictures of a measurement that is not finished. Each has a file of its own as soon as it takes
/// longer than a moment.
#[derive(Debug)]
pub struct Films<'a> {
    store: &'a Store,
    /// Name of the measurement's file without its ending.
    stem: String,
    key: &'a str,
    paths: RefCell<Vec<PathBuf>>,
}

impl Films<'_> {
    /// Renders the whole picture of a scene, or the rest of it if an earlier run has left a part.
    ///
    /// # Errors
    ///
    /// Returns an error if the picture cannot be saved, and [`Error::Interrupted`] if the run is stopped.
    pub fn render(
        &self,
        scene: &Scene,
        settings: &Settings,
        samples: u32,
        picture: u64,
    ) -> Result<Film, Error> {
        let path = self
            .store
            .folder
            .join(format!("{}-{picture}.film", self.stem));
        self.paths.borrow_mut().push(path.clone());
        let fresh = || Part {
            run: format!("{} picture={picture}", self.key),
            film: Film::new(Crop::whole(scene.camera.size())),
            finished: false,
        };
        let resumed = Part::resume(&path, fresh(), Some(samples)).or_else(|error| match error {
            Error::Part { path, problem } => {
                say(&format!("{}: {problem}; rendered again", path.display()));
                Ok((fresh(), Log::new(&path)))
            }
            error => Err(error),
        });
        let (mut part, log) = resumed?;
        let (start, mut saver) = (Instant::now(), Saver::new(log, &self.store.interrupt));
        let pass = match settings.integrator {
            Integrator::Gather => GATHER_PASS,
            Integrator::Direct | Integrator::Path | Integrator::Dual => PATH_PASS,
        };
        let mut done = part.film.samples();
        while done < samples {
            done = samples.min(done + pass);
            saver.render(&mut part, scene, settings, done, &|_| ())?;
        }
        if start.elapsed() > MOMENT {
            saver.save(&part)?;
        }
        Ok(part.film)
    }
}

/// Rejects a measurement in another format, with an error that names the file.
fn check_format(path: &Path) -> Result<(), Error> {
    let mut first = String::new();
    // A file that cannot be read or is no text is damaged, or is no measurement.
    let line = fs::File::open(path).map(|file| BufReader::new(file.take(80)).read_line(&mut first));
    if line.is_ok() && first.starts_with(FORMAT) && first.trim_end() != MAGIC {
        let (path, got) = (path.display(), first.trim_end());
        return Err(Error::Usage(format!(
            "{path}: expected \"{MAGIC}\", got \"{got}\": remove the file"
        )));
    }
    Ok(())
}

/// Reads a measurement. Returns `None` if there is no file, or, with a remark, if the file is damaged.
fn read(path: &Path, key: &str) -> Option<Runs> {
    let problem = match fs::read(path) {
        Ok(bytes) => match parse(&bytes, key) {
            Some(measured) => return Some(measured),
            None => "damaged".to_owned(),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
        Err(error) => format!("cannot read: {error}"),
    };
    say(&format!("{}: {problem}; measured again", path.display()));
    None
}

/// Encodes a measurement as two lines of text, the numbers, and a digest of both.
fn bytes(measured: &Runs, key: &str) -> Vec<u8> {
    let Runs {
        samples,
        seconds,
        errors,
        variance,
        picture,
        bias,
        squares,
    } = measured;
    let mut bytes = format!("{MAGIC}\n{key}\n").into_bytes();
    bytes.extend(samples.to_le_bytes());
    bytes.extend((errors.len() as u64).to_le_bytes());
    bytes.extend(picture.size.into_iter().flat_map(u32::to_le_bytes));
    let times = [*seconds, variance.value, variance.standard_error];
    let errors = errors
        .iter()
        .flat_map(|Errors { values, own }| values.iter().chain(own))
        .copied();
    let pixels = picture
        .pixels
        .iter()
        .flatten()
        .chain(bias)
        .chain(squares)
        .copied();
    bytes.extend(
        times
            .into_iter()
            .chain(errors)
            .chain(pixels)
            .flat_map(f64::to_le_bytes),
    );
    seal(&mut bytes);
    bytes
}

/// Decodes a measurement. Returns `None` if the bytes are damaged, or if they are not those of a measurement with this key: its
/// settings and its build.
#[must_use]
pub fn parse(bytes: &[u8], key: &str) -> Option<Runs> {
    let rest = unseal(bytes)?
        .strip_prefix(MAGIC.as_bytes())?
        .strip_prefix(b"\n")?;
    let rest = rest.strip_prefix(key.as_bytes())?.strip_prefix(b"\n")?;
    let mut rest = Reader::new(rest);
    let (samples, pictures) = (rest.number()?, u64::from_le_bytes(rest.bytes()?));
    let size = [rest.number()?, rest.number()?];
    let seconds = rest.double()?;
    let variance = Estimate {
        value: rest.double()?,
        standard_error: rest.double()?,
    };
    let mut errors = Vec::new();
    for _ in 0..pictures {
        let mut measured = Errors::default();
        for error in measured.values.iter_mut().chain(&mut measured.own) {
            *error = rest.double()?;
        }
        errors.push(measured);
    }
    let count = Crop::whole(size).len();
    let mut doubles = |count: usize| {
        (0..count)
            .map(|_| rest.double())
            .collect::<Option<Vec<f64>>>()
    };
    let pixels = doubles(3 * count)?.as_chunks::<3>().0.to_vec();
    let mapped = if pictures == 0 { 0 } else { count };
    let (bias, squares) = (doubles(mapped)?, doubles(mapped)?);
    rest.is_empty().then_some(Runs {
        samples,
        seconds,
        errors,
        variance,
        picture: Picture { size, pixels },
        bias,
        squares,
    })
}
