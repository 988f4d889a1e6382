//! Slots, each of which holds a material of any model and a view of the material.

use core::f32::consts::FRAC_1_SQRT_2;
use hairis::model::Model;
use hairis::simd::Vec3x;
use hairis::{Bsdf, HairParams, Hit, Lobe, LobeMask, Material, ParamError};
use hairis_variants::{ModelId, Parameters, Registered, Values, Visitor};

/// Material of any model with a view of the material.
pub(crate) struct Slot {
    /// Material, once the host has set one.
    material: Option<(ModelId, Values)>,
    pub(crate) hit: Hit,
    /// Bits of the lobes that are switched on.
    pub(crate) lobes: u32,
}

impl Slot {
    /// Slot without a material, viewed at an inclination of 45 degrees.
    pub(crate) const NONE: Self = Self {
        material: None,
        hit: Hit {
            wo: Vec3x {
                x: FRAC_1_SQRT_2,
                y: FRAC_1_SQRT_2,
                z: 0.0,
            },
            h: 0.0,
        },
        lobes: 0b1111,
    };

    /// Sets the material from those fields of `numbers` whose bit in `given` is set, and then writes the numbers of all fields back.
    pub(crate) fn set(
        &mut self,
        id: ModelId,
        numbers: &mut [f32],
        given: u32,
    ) -> Result<(), ParamError> {
        let values = id.visit(Check { numbers, given })?;
        self.material = Some((id, values));
        write(&values, numbers);
        Ok(())
    }

    /// Returns the first model with the name of the slot's model, which represents all of them where nothing is sampled.
    pub(crate) fn first(&self) -> ModelId {
        let name = self.material.map_or("", |(id, _)| id.name());
        ModelId::find(name, None).unwrap_or(ModelId::ALL[0])
    }

    pub(crate) fn params<M: Registered>(&self) -> M::Params {
        let values = self.material.filter(|(id, _)| id.name() == M::NAME);
        values
            .and_then(|(_, values)| M::Params::from_values(&values).ok())
            .unwrap_or_default()
    }

    /// Returns the parameters if the slot has the published model or a variant of it, and the default parameters otherwise.
    pub(crate) fn hair(&self) -> HairParams {
        let values = self.material.map(|(_, values)| values);
        let values = values.filter(|values| values.fields() == HairParams::FIELDS);
        values
            .and_then(|values| HairParams::from_values(&values).ok())
            .unwrap_or_default()
    }

    pub(crate) fn material<M: Registered>(&self) -> Material<M> {
        Material::new(&M::MODEL, &self.params::<M>())
    }

    pub(crate) fn bsdf<M: Registered>(&self) -> Bsdf<M> {
        self.restricted(&self.material::<M>().prepare(self.hit))
    }

    /// Returns the BSDF restricted to the slot's lobes.
    pub(crate) fn restricted<M: Model>(&self, bsdf: &Bsdf<M>) -> Bsdf<M> {
        let mut chosen = [Lobe::R; Lobe::COUNT];
        let mut count = 0;
        for lobe in Lobe::ALL.into_iter().take(M::LOBES.len()) {
            if self.lobes >> lobe.index() & 1 == 1 {
                chosen[count] = lobe;
                count += 1;
            }
        }
        if count >= M::LOBES.len() {
            *bsdf
        } else {
            bsdf.with_lobes(LobeMask::of(&chosen[..count]))
        }
    }
}

/// Visitor that makes parameters from numbers, checks them, and returns the values of all fields.
struct Check<'a> {
    numbers: &'a [f32],
    given: u32,
}

impl Visitor for Check<'_> {
    type Output = Result<Values, ParamError>;

    fn visit<M: Registered>(self) -> Self::Output {
        // Fields that are not given have their defaults, unless other fields stand in for them.
        let mut values = M::Params::default().values();
        let mut at = 0;
        for (index, field) in M::Params::FIELDS.iter().enumerate() {
            let width = field.kind.width();
            if self.given >> index & 1 == 1 {
                // Cannot fail, because the slice has as many numbers as the field.
                let _ = values.set_at(index, &self.numbers[at..at + width]);
            }
            at += width;
        }
        Ok(M::Params::from_values(&values)?.values())
    }
}

/// Writes the numbers of every field that has a value, each field at its place among all fields.
pub(crate) fn write(values: &Values, to: &mut [f32]) {
    let mut at = 0;
    for (index, field) in values.fields().iter().enumerate() {
        let width = field.kind.width();
        if values.has_at(index) {
            to[at..at + width].copy_from_slice(values.numbers_at(index));
        }
        at += width;
    }
}
