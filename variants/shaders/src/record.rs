//! Records of numbers: the layout of materials, of shading points and of results.

use hairis::simd::{LaneStruct, Path, Scalar};

/// Form of a field of a record: a number, a vector or an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A single number.
    Number,
    /// Three numbers, `x`, `y` and `z`: a direction, a colour, or uniform numbers.
    Vector,
    /// An array with the given length.
    Array(usize),
}

/// Named part of a record, which holds one number, a vector or an array.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Field {
    /// Name of the field. Fields of nested structs are joined by underscores.
    pub name: String,
    /// Form of the field, which determines how many numbers the field holds.
    pub shape: Shape,
    /// Meaning of the field, or an empty string if the name says it.
    pub doc: String,
}

impl Field {
    pub(crate) fn new(name: impl Into<String>, shape: Shape) -> Self {
        let name = name.into();
        let doc = String::new();
        Self { name, shape, doc }
    }

    /// Returns the number of numbers that the field holds: three for a vector, and the length of an array.
    #[must_use]
    pub fn len(&self) -> usize {
        match self.shape {
            Shape::Number => 1,
            Shape::Vector => 3,
            Shape::Array(len) => len,
        }
    }

    /// Returns true if the field holds no number, as an empty array does.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the name of each number of the field as every language writes it: `pdf`, `wi.x`, `lobes_alpha[2]`.
    pub fn places(&self) -> impl Iterator<Item = String> + '_ {
        let name = &self.name;
        (0..self.len()).map(move |i| match self.shape {
            Shape::Number => name.clone(),
            Shape::Vector => format!("{name}.{}", ["x", "y", "z"][i]),
            Shape::Array(_) => format!("{name}[{i}]"),
        })
    }
}

/// Fields in a fixed order. In memory their numbers follow each other, four bytes each, unless the record has vectors.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Record {
    /// Name of the record, from which the name of the printed type is formed: `material`, `prepared`, `eval`.
    pub name: String,
    /// Fields in the order in which the printed type declares them.
    pub fields: Vec<Field>,
}

impl Record {
    pub(crate) fn new(name: &str, fields: &[(&str, Shape)]) -> Self {
        let fields = fields
            .iter()
            .map(|(field, shape)| Field::new(*field, *shape));
        Self {
            name: name.to_owned(),
            fields: fields.collect(),
        }
    }

    /// Returns the layout of a struct of lanes, and its numbers in the order of that layout.
    pub(crate) fn of<S: LaneStruct>(name: &str, lanes: &S) -> (Self, Vec<S::Number>) {
        let (mut fields, mut numbers) = (Vec::<Field>::new(), Vec::new());
        lanes.visit(&Path::Root, &mut |path, number| {
            numbers.push(number);
            let (name, is_array) = field(path);
            match fields.last_mut() {
                Some(Field {
                    name: last,
                    shape: Shape::Array(len),
                    ..
                }) if *last == name => *len += 1,
                _ if is_array => fields.push(Field::new(name, Shape::Array(1))),
                _ => fields.push(Field::new(name, Shape::Number)),
            }
        });
        let name = name.to_owned();
        (Self { name, fields }, numbers)
    }

    /// Returns the number of numbers in all fields of the record.
    #[must_use]
    pub fn len(&self) -> usize {
        self.fields.iter().map(Field::len).sum()
    }

    /// Returns true if none of the fields holds a number.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the name of each number of the record in order, as every language writes it.
    pub fn places(&self) -> impl Iterator<Item = String> + '_ {
        self.fields.iter().flat_map(Field::places)
    }
}

/// Returns the name of the field that a number belongs to, and whether the number is an entry of an array. Arrays of arrays are flattened
/// to one array; array entries that are structs are named by their index.
fn field(path: &Path<'_>) -> (String, bool) {
    match *path {
        Path::Root => (String::new(), false),
        Path::Field(parent, name) => (join(parent, name), false),
        Path::Entry(parent, ..) => (field(parent).0, true),
    }
}

fn join(parent: &Path<'_>, name: &str) -> String {
    match *parent {
        Path::Root => name.to_owned(),
        Path::Field(above, field) => format!("{}_{name}", join(above, field)),
        Path::Entry(array, index, _) => format!("{}_{index}_{name}", field(array).0),
    }
}

/// Returns the numbers of a struct in the order of its record, which is the order in which a host uploads them.
#[must_use]
pub fn numbers<S: LaneStruct<Number = C>, C: Scalar>(lanes: &S) -> Vec<C> {
    Record::of("", lanes).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis::simd::lane_struct;

    lane_struct! {
        /// A struct in an array.
        pub struct Inner {
            /// A number.
            pub x: C,
            /// An array.
            pub y: [C; 2],
        }
    }
    lane_struct! {
        /// A struct of structs.
        pub struct Outer {
            /// An array of structs.
            pub inner: [Inner<C>; 2],
            /// An array of arrays.
            pub z: [[C; 2]; 2],
            /// A struct.
            pub one: Inner<C>,
        }
    }

    #[test]
    fn fields_are_flat_and_in_order() {
        let inner = |from: f32| Inner {
            x: from,
            y: [from + 1.0, from + 2.0],
        };
        let outer = Outer {
            inner: [inner(0.0), inner(3.0)],
            z: [[6.0, 7.0], [8.0, 9.0]],
            one: inner(10.0),
        };
        let (record, numbers) = Record::of("outer", &outer);
        let places: Vec<_> = record.places().collect();
        let expected = "inner_0_x inner_0_y[0] inner_0_y[1] inner_1_x inner_1_y[0] inner_1_y[1] z[0] z[1] z[2] z[3] one_x \
                        one_y[0] one_y[1]";
        assert_eq!(places, expected.split_whitespace().collect::<Vec<_>>());
        assert!(
            numbers.is_sorted() && numbers.len() == record.len(),
            "{numbers:?}"
        );
    }
}
