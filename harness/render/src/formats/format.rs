//! The formats, and which of them a file has.

use super::bytes::Bytes;
use super::raw::Raw;
use super::{Problem, Wrong, counted, cyhair, mitsuba, monohair, ply, ply_strands, tressfx};
use std::path::Path;

/// A format of hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    CyHair,
    MonoHair,
    TressFx,
    /// USC-HairSalon: counted strands of places.
    HairSalon,
    /// `CT2Hair`: the same, with a normal and a label beside each place.
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

    /// Name in messages, and the endings that its files have; the formats of an ending in the order
    /// in which damaged files are taken for them.
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

    /// The format of the content, or else the one of the name's ending.
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

    /// Whether the content is of the format, as far as its beginning or its counts show.
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

    /// The strands, checked; their radii only if they are wanted.
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

    /// Says that the name promises something else.
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

/// The ending of a name, in small letters.
fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}
