//! Computation of materials from parameters.

use crate::call::Call;
use crate::function::{Argument, Function};
use crate::graph::{Lane, input, record};
use crate::record::{Field, Record, Shape, numbers};
use hairis::model::Single;
use hairis::simd::Lanes;
use hairis::simd::trace::Target;
use hairis_variants::{Kind, Parameters, Registered, Values};

/// Returns the fields that have a value, with their places.
fn kept(values: &Values) -> impl Iterator<Item = (usize, &'static hairis_variants::Field)> {
    let places = values.fields().iter().enumerate();
    places.filter(|(place, _)| values.has_at(*place))
}

/// Returns the layout of the parameters, whose fields have the names that `hairis eval` uses.
pub(crate) fn params<P: Parameters>() -> Record {
    let defaults = P::default().values();
    let fields = kept(&defaults).map(|(_, field)| {
        let (shape, labels) = match field.kind {
            Kind::Number => (Shape::Number, String::new()),
            Kind::Numbers(labels) => (Shape::Array(labels.len()), labels.join(", ")),
            Kind::Rgb => (Shape::Array(3), "linear red, green and blue".to_owned()),
            Kind::Word(words) => {
                let words = words.iter().enumerate();
                let words: Vec<_> = words.map(|(i, word)| format!("{i} {word}")).collect();
                (Shape::Number, words.join(", "))
            }
        };
        let rule = field.rule.map(|rule| rule.to_string());
        let notes: Vec<_> = [labels, rule.unwrap_or_default()]
            .into_iter()
            .filter(|note| !note.is_empty())
            .collect();
        let doc = format!("{}: {}", field.doc.trim_end_matches('.'), notes.join("; "));
        Field {
            doc,
            ..Field::new(field.name, shape)
        }
    });
    Record {
        name: "params".to_owned(),
        fields: fields.collect(),
    }
}

/// Returns the numbers that [`Call::Material`] reads: the numbers of all fields that the parameters keep, in order. A field in place of one
/// of these, such as a colour, is not among them.
#[must_use]
pub fn parameters(params: &impl Parameters) -> Vec<f32> {
    let values = params.values();
    kept(&values)
        .flat_map(|(place, _)| values.numbers_at(place).to_vec())
        .collect()
}

/// Traces [`Call::Material`] of a model of the list.
pub(crate) fn material<M: Registered>(target: Target, output: &Record) -> Function {
    let params = params::<M::Params>();
    let (graph, results) = record(target, || {
        let defaults = M::Params::default().values();
        let slots = defaults.fields().iter().enumerate();
        let slots = slots.flat_map(|(place, field)| {
            core::iter::repeat_n(defaults.has_at(place), field.kind.width())
        });
        let mut is_read = slots.collect::<Vec<_>>().into_iter();
        let next = &mut 0;
        let values = defaults.map(|_| match is_read.next() {
            Some(true) => input(next),
            _ => Lane::splat(0.0),
        });
        Lane::stage("words among the parameters");
        let material = M::constants::<Single<Lane>>(&values);
        let numbers = numbers(&material).into_iter();
        numbers.map(Lane::name).collect::<Vec<_>>()
    });
    let name = Call::Material.name().to_owned();
    let params = Argument::Record(params.name.clone(), params);
    Function::new(name, vec![params], output.clone(), &graph, &results)
}
