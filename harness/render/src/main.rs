//! Command `hairis-render`; everything else is in the library.

use hairis_instruments::program;
use hairis_render::args::Args;
use hairis_render::cmd;
use std::process::ExitCode;

/// Text that `hairis-render` prints without arguments.
const ENTRANCE: &str = "\
hairis-render renders hair, and measures on pictures what models and samplers
are worth.

  render    a scene, or hair of a file: an EXR file with a PNG beside it
  figures   samplers on every scene, at equal samples and equal time: one page
  fit       the material of the hair in a picture
  merge     one picture from the parts that several machines have rendered

Try:
  hairis-render render head --model chiang --integrator path --spp 16
  hairis-render render portraits --mis resampled --size 800x360 --spp 16
  hairis-render figures --quick

hairis-render COMMAND --help lists the flags of a command.
";

fn main() -> ExitCode {
    program::run("hairis-render", Some(ENTRANCE), |args: &Args| {
        cmd::run(&args.command)
    })
}
