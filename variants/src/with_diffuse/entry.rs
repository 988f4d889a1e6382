//! Registry entries of models with a diffuse part: their names, and their constants in any precision.

use super::{DiffuseMaterial, DiffusePresets, WithDiffuse, WithDiffuseMaterial};
use crate::{Parameters, Registered, Values};
use hairis::model::Precision;

impl<M: Registered> WithDiffuse<M> {
    const SUFFIX: &'static [u8] = b"-diffuse";
    const BYTES: [u8; 32] = {
        let mut bytes = [0; 32];
        let (name, mut place) = (M::NAME.as_bytes(), 0);
        while place < name.len() + Self::SUFFIX.len() {
            bytes[place] = if place < name.len() {
                name[place]
            } else {
                Self::SUFFIX[place - name.len()]
            };
            place += 1;
        }
        bytes
    };
}

impl<M: Registered<Params: DiffusePresets>> Registered for WithDiffuse<M> {
    const NAME: &'static str = {
        let len = M::NAME.len() + Self::SUFFIX.len();
        match core::str::from_utf8(Self::BYTES.split_at(len).0) {
            Ok(name) => name,
            Err(_) => panic!("names of models are UTF-8"),
        }
    };
    const CHOICE: Option<(&'static str, &'static str)> = M::CHOICE;
    const MODEL: Self = Self(M::MODEL);
    const NEAR_FIELD: bool = M::NEAR_FIELD;
    const COLORS: Option<&'static str> = M::COLORS;

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> Self::Material<W::Lane> {
        let fields = <M::Params as Parameters>::FIELDS;
        WithDiffuseMaterial {
            fiber: M::constants::<W>(&values.of_fields(fields)),
            diffuse: DiffuseMaterial::new(
                values.number_at(fields.len()),
                values.get_at(fields.len() + 1),
            ),
        }
    }
}
