//! JSON text that lists the models, their fields and presets, and the artist's controls.

use crate::artist::CONTROLS;
use crate::memory::{COLUMN, Text};
use core::fmt::{self, Display};
use hairis::HairParams;
use hairis_variants::{Draw, Field, Kind, ModelId, Parameters, Registered, Values, Visitor};

macro_rules! say {
    ($text:expr, $($arguments:tt)*) => { $text.say(&format_args!($($arguments)*)) };
}

/// Text that is displayed as a JSON string.
struct Quoted<'a>(&'a str);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"")?;
        for part in self.0.split_inclusive(['"', '\\']) {
            let (plain, last) = part.split_at(part.len() - part.ends_with(['"', '\\']) as usize);
            f.write_str(plain)?;
            if !last.is_empty() {
                write!(f, "\\{last}")?;
            }
        }
        f.write_str("\"")
    }
}

/// Items that are displayed as a JSON array.
struct List<I>(I);

impl<I: Iterator<Item: Display> + Clone> Display for List<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[")?;
        for (place, item) in self.0.clone().enumerate() {
            f.write_str(if place > 0 { "," } else { "" })?;
            item.fmt(f)?;
        }
        f.write_str("]")
    }
}

fn quoted<'a>(words: &'a [&'a str]) -> List<impl Iterator<Item = Quoted<'a>> + Clone> {
    List(words.iter().map(|word| Quoted(word)))
}

/// Field that is displayed as a JSON object.
struct FieldText<'a>(&'a Field);

impl Display for FieldText<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let field = self.0;
        let (kind, words): (_, &[&str]) = match field.kind {
            Kind::Number => ("number", &[]),
            Kind::Numbers(names) => ("numbers", names),
            Kind::Rgb => ("rgb", &[]),
            Kind::Word(words) => ("word", words),
        };
        write!(
            f,
            "{{\"name\":{},\"kind\":\"{kind}\",\"words\":{},\"unit\":\"{}\",\"doc\":{},\"optional\":{}",
            Quoted(field.name),
            quoted(words),
            field.unit,
            Quoted(field.doc),
            field.optional
        )?;
        if let Some([least, most]) = field.range() {
            write!(f, ",\"range\":[{least},{most}]")?;
        }
        if let Some(name) = field.instead_of {
            write!(f, ",\"instead_of\":{}", Quoted(name))?;
        }
        if let Some(Draw {
            least,
            most,
            unit,
            log,
        }) = field.draw
        {
            write!(
                f,
                ",\"draw\":[{},{}],\"log\":{log}",
                least * unit,
                most * unit
            )?;
        }
        f.write_str("}")
    }
}

/// Values that are displayed as the object `params` of `hairis eval`.
struct Params(Values);

impl Display for Params {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut mark = "{";
        for (index, field) in self.0.fields().iter().enumerate() {
            if !self.0.has_at(index) {
                continue;
            }
            write!(f, "{mark}{}:", Quoted(field.name))?;
            mark = ",";
            let numbers = self.0.numbers_at(index);
            match field.kind {
                Kind::Word(_) => Quoted(self.0.word(field.name)).fmt(f)?,
                Kind::Number => numbers[0].fmt(f)?,
                _ => List(numbers.iter()).fmt(f)?,
            }
        }
        f.write_str("}")
    }
}

/// Writes the JSON object with the keys `column`, `models` and `artist`.
pub(crate) fn write(text: &mut Text) {
    struct Facts;
    impl Visitor for Facts {
        type Output = (bool, bool);
        fn visit<M: Registered>(self) -> (bool, bool) {
            (M::NEAR_FIELD, M::CONSERVES)
        }
    }
    say!(text, "{{\"column\":{COLUMN},\"models\":[");
    for (place, first) in ModelId::defaults_of_names().enumerate() {
        let (near_field, conserves) = first.visit(Facts);
        let name = first.name();
        say!(
            text,
            "{}{{\"name\":{},\"lobes\":{},\"near_field\":{near_field},\"conserves\":{conserves},\"artist\":{},\"choice\":{},\"entries\":[",
            if place > 0 { "," } else { "" },
            Quoted(name),
            quoted(first.lobes()),
            first.fields() == HairParams::FIELDS,
            Quoted(first.choice().map_or("", |(field, _)| field))
        );
        let mut mark = "";
        for (index, id) in ModelId::ALL.iter().enumerate() {
            if id.name() == name {
                let word = Quoted(id.choice().map_or("", |(_, word)| word));
                say!(text, "{mark}{{\"model\":{index},\"word\":{word}}}");
                mark = ",";
            }
        }
        let fields = List(first.fields().iter().map(FieldText));
        say!(text, "],\"fields\":{fields},\"presets\":{{");
        for (place, (name, values)) in first.presets().enumerate() {
            let mark = if place > 0 { "," } else { "" };
            say!(text, "{mark}{}:{}", Quoted(name), Params(values));
        }
        say!(text, "}}}}");
    }
    say!(text, "],\"artist\":[");
    for (place, control) in CONTROLS.iter().enumerate() {
        let [least, most] = control.range;
        say!(
            text,
            "{}{{\"name\":{},\"kind\":\"{}\",\"unit\":\"{}\",\"range\":[{least},{most}]}}",
            if place > 0 { "," } else { "" },
            Quoted(control.name),
            if control.width == 3 { "rgb" } else { "number" },
            control.unit
        );
    }
    say!(text, "]}}");
}
