//! Formats of hair, and the rules that decide which of them a file has.

use super::bytes::Bytes;
use super::raw::Raw;
use super::{Problem, Wrong, counted, cyhair, mitsuba, monohair, ply, ply_strands, tressfx};
use std::path::Path;

/// Format of a file of hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    CyHair,
    MonoHair,
    TressFx,
    /// USC-HairSalon: counted strands of positions.
    HairSalon,
    /// `CT2Hair`: counted strands, with a normal and a label beside each position.
    Ct2Hair,
    Ply,
    MitsubaText,
    MitsubaBinary,
}

impl Format {
    const ALL: [Self; 8] = [
        Self::CyHair,
        Self::MonoHair,
        Self::TressFx,
        Self::HairSalon,
        Self::Ct2Hair,
        Self::Ply,
        Self::MitsubaText,
        Self::MitsubaBinary,
    ];

    /// Returns the name in messages, and the endings that files of the format have. Formats that share an
    /// ending are in the order in which damaged files are taken for them.
    fn words(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::CyHair => ("cyHair", &["hair"]),
            Self::MonoHair => ("MonoHair", &["hair"]),
            Self::TressFx => ("TressFX", &["tfx"]),
            Self::HairSalon => ("USC-HairSalon", &["data"]),
            Self::Ct2Hair => ("CT2Hair", &["bin"]),
            Self::Ply => ("PLY", &["ply"]),
            Self::MitsubaText => ("Mitsuba's text", &["txt", "hair", "mitshair"]),
            Self::MitsubaBinary => ("Mitsuba's binary hair", &["hair", "mitshair", "bin"]),
        }
    }

    /// Returns the format of the content, or else the format of the name's ending.
    pub(super) fn of(bytes: Bytes<'_>, path: &Path) -> Result<Self, Problem> {
        let ending = ending(path);
        let named = |format: &&Self| format.words().1.contains(&ending.as_str());
        let fitting: Vec<Self> = Self::ALL
            .into_iter()
            .filter(|format| format.fits(bytes))
            .collect();
        let by_name = || Self::ALL.iter().find(named);
        fitting
            .iter()
            .find(named)
            .or_else(|| fitting.first())
            .or_else(by_name)
            .copied()
            .ok_or(Problem::Unknown)
    }

    /// Returns true if the content is of the format, as far as its beginning or its counts show.
    fn fits(self, bytes: Bytes<'_>) -> bool {
        match self {
            Self::CyHair => bytes.0.starts_with(b"HAIR"),
            Self::MonoHair => monohair::fits(bytes),
            Self::TressFx => tressfx::fits(bytes),
            Self::HairSalon => counted::fits(bytes, counted::HAIR_SALON),
            Self::Ct2Hair => counted::fits(bytes, counted::CT2HAIR),
            Self::Ply => ply::fits(bytes),
            Self::MitsubaText => mitsuba::is_text(bytes),
            Self::MitsubaBinary => mitsuba::is_binary(bytes),
        }
    }

    /// Checks the file and returns its strands, with radii only if they are wanted.
    pub(super) fn parse(self, bytes: Bytes<'_>, radii: bool) -> Result<Raw<'_>, Wrong> {
        match self {
            Self::CyHair => cyhair::parse(bytes, radii),
            Self::MonoHair => monohair::parse(bytes),
            Self::TressFx => tressfx::parse(bytes),
            Self::HairSalon => counted::parse(bytes, counted::HAIR_SALON),
            Self::Ct2Hair => counted::parse(bytes, counted::CT2HAIR),
            Self::Ply => ply_strands::parse(bytes, radii),
            Self::MitsubaText => mitsuba::parse_text(bytes, radii),
            Self::MitsubaBinary => mitsuba::parse_binary(bytes),
        }
    }

    /// Returns a remark if the ending of the name does not belong to the format.
    pub(super) fn remark(self, path: &Path) -> Option<String> {
        let ending = ending(path);
        let (name, endings) = self.words();
        let remark = match ending.as_str() {
            "" => format!("read as {name}: the name has no ending"),
            _ => format!("read as {name}, which the name's ending .{ending} does not say"),
        };
        (!endings.contains(&ending.as_str())).then_some(remark)
    }
}

/// Returns the ending of a name in lower case.
fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}
