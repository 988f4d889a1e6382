//! Structs and codes that both sides of the interface share. A test in C compares each with the header.

use core::ffi::c_char;

/// A struct as the C compiler must see it.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name in the header.
    pub name: &'static str,
    /// Size in bytes.
    pub size: usize,
    /// Alignment in bytes.
    pub align: usize,
    /// Name, offset and size of each field.
    pub fields: &'static [(&'static str, usize, usize)],
}

/// Declares structs of C, and the table of their layouts.
macro_rules! structs {
    ($($(#[$meta:meta])* $name:ident = $c:literal { $($(#[$doc:meta])* $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$meta])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug)]
            pub struct $name {
                $($(#[$doc])* pub $field: $type,)*
            }
        )*

        /// Every struct of the header.
        pub const LAYOUTS: &[Layout] = &[$(Layout {
            name: $c,
            size: size_of::<$name>(),
            align: align_of::<$name>(),
            fields: &[$((stringify!($field), core::mem::offset_of!($name, $field), size_of::<$type>())),*],
        }),*];
    };
}

/// Declares constants of C, and their table.
macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident: $type:ty = $value:expr, $c:literal;)*) => {
        $($(#[$doc])* pub const $name: $type = $value;)*

        /// Every constant of the header.
        #[expect(
            clippy::cast_possible_wrap,
            reason = "small constants of several types"
        )]
        pub const CONSTANTS: &[(&str, i64)] = &[$(($c, $name as i64)),*];
    };
}

constants! {
    /// Version of the interface: the number in the name of the shared library.
    ABI_VERSION: u32 = 1, "HAIRIS_ABI_VERSION";
    /// Bytes of a material.
    MATERIAL_SIZE: usize = 1536, "HAIRIS_MATERIAL_SIZE";
    /// Bytes of a BSDF.
    BSDF_SIZE: usize = 1024, "HAIRIS_BSDF_SIZE";
    /// Largest count of numbers of a model.
    NUMBERS: usize = 32, "HAIRIS_NUMBERS";
    /// Success.
    OK: i32 = 0, "HAIRIS_OK";
    /// No such model, choice, preset, field or word.
    NAME: i32 = 1, "HAIRIS_NAME";
    /// A value out of its range, or another count of numbers.
    VALUE: i32 = 2, "HAIRIS_VALUE";
    /// A null pointer, an unknown code, or an index outside the materials.
    ARGUMENT: i32 = 3, "HAIRIS_ARGUMENT";
    /// The model as it is.
    ENERGY_RAW: u32 = 0, "HAIRIS_ENERGY_RAW";
    /// No more light than arrives, direction by direction.
    ENERGY_CONSERVING: u32 = 1, "HAIRIS_ENERGY_CONSERVING";
    /// No more light than arrives, by one factor.
    ENERGY_SCALED: u32 = 2, "HAIRIS_ENERGY_SCALED";
    /// A number.
    KIND_NUMBER: u32 = 0, "HAIRIS_KIND_NUMBER";
    /// Numbers, each with a label.
    KIND_NUMBERS: u32 = 1, "HAIRIS_KIND_NUMBERS";
    /// Linear red, green and blue.
    KIND_RGB: u32 = 2, "HAIRIS_KIND_RGB";
    /// A word of a list.
    KIND_WORD: u32 = 3, "HAIRIS_KIND_WORD";
    /// All light.
    PARTITION_ALL: u32 = 0, "HAIRIS_PARTITION_ALL";
    /// The light technique's share by the balance heuristic.
    PARTITION_BALANCE: u32 = 1, "HAIRIS_PARTITION_BALANCE";
    /// The light technique's share by the power heuristic.
    PARTITION_POWER: u32 = 2, "HAIRIS_PARTITION_POWER";
}

/// Bytes before the constants of a handle.
pub const HEAD_SIZE: usize = 16;

structs! {
    /// Refusal.
    Error = "hairis_error" {
        /// Status.
        code: i32,
        /// Place of the number at fault in its field, or -1.
        number: i32,
        /// Value at fault.
        value: f32,
        /// Field at fault.
        field: [c_char; 32],
        /// A sentence.
        message: [c_char; 212],
    }
    /// Entry of the list of models.
    ModelInfo = "hairis_model_info" {
        /// Name of the model.
        name: [c_char; 32],
        /// Field that selects among the entries of one name.
        choice: [c_char; 32],
        /// Word of that field.
        word: [c_char; 32],
        /// Names of the lobes, by slot.
        lobe_names: [[c_char; 16]; 4],
        /// Number of lobes.
        lobes: u32,
        /// Number of fields.
        fields: u32,
        /// Number of presets.
        presets: u32,
        /// Whether the model reads `h`.
        near_field: u32,
        /// Whether the entry is the first of its name.
        is_default: u32,
    }
    /// Field of a model's parameters.
    FieldInfo = "hairis_field_info" {
        /// Name.
        name: [c_char; 32],
        /// Field that it may take the place of.
        instead_of: [c_char; 32],
        /// Shape of the value.
        kind: u32,
        /// Count of numbers.
        width: u32,
        /// Place of the first number among all numbers of the parameters.
        first: u32,
        /// Whether the field may be left out.
        optional: u32,
        /// Smallest number that is accepted.
        least: f32,
        /// Largest number that is accepted.
        most: f32,
        /// Count of labels.
        labels: u32,
        /// Words of the field, or a label for each number.
        label: [[c_char; 16]; 4],
        /// Unit of the numbers.
        unit: [c_char; 8],
        /// A sentence.
        doc: [c_char; 128],
    }
    /// Values of the fields of a model.
    Params = "hairis_params" {
        /// Index of the model.
        model: u32,
        /// Bit `i` for a field `i` that has a value.
        given: u32,
        /// Numbers of all fields, in their order.
        numbers: [f32; NUMBERS],
    }
    /// Highlight in an artist's terms.
    Highlight = "hairis_highlight" {
        /// Linear RGB.
        color: [f32; 3],
        /// Factor on the colour.
        intensity: f32,
        /// Shift along the fibre, degrees.
        shift_deg: f32,
        /// Width along the fibre, degrees.
        width_deg: f32,
    }
    /// Light through the fibre in an artist's terms.
    Transmission = "hairis_transmission" {
        /// Linear RGB.
        color: [f32; 3],
        /// Factor on the colour.
        intensity: f32,
        /// Shift along the fibre, degrees.
        shift_deg: f32,
        /// Width along the fibre, degrees.
        width_deg: f32,
        /// Width around the fibre, degrees.
        azimuthal_width_deg: f32,
    }
    /// Glints in an artist's terms.
    Glints = "hairis_glints" {
        /// Strength relative to the secondary highlight.
        strength: f32,
        /// Angle from one glint to the other, degrees.
        separation_deg: f32,
        /// Width of each glint around the fibre, degrees.
        azimuthal_width_deg: f32,
    }
    /// Hair in an artist's terms.
    Artist = "hairis_artist" {
        /// Primary highlight.
        primary: Highlight,
        /// Light through the fibre.
        transmission: Transmission,
        /// Secondary highlight.
        secondary: Highlight,
        /// Glints of the secondary highlight.
        glints: Glints,
    }
    /// Material of any model: a head with the tag, and the Rust handle behind it.
    #[repr(align(16))]
    RawMaterial = "hairis_material" {
        /// Tag of the model.
        head: [u32; 4],
        /// Constants of the material.
        body: [u8; MATERIAL_SIZE - HEAD_SIZE],
    }
    /// BSDF of any model: a head with the tag, and the Rust handle behind it.
    #[repr(align(16))]
    RawBsdf = "hairis_bsdf" {
        /// Tag of the model.
        head: [u32; 4],
        /// Constants of the BSDF.
        body: [u8; BSDF_SIZE - HEAD_SIZE],
    }
    /// Value and density.
    #[derive(Default)]
    EvalResult = "hairis_eval_result" {
        /// S, linear RGB.
        value: [f32; 3],
        /// Density.
        pdf: f32,
    }
    /// A lobe at a direction.
    #[derive(Default)]
    LobeResult = "hairis_lobe_result" {
        /// The lobe's part of S without its colour.
        value: f32,
        /// Colour, linear RGB.
        color: [f32; 3],
        /// Density of the lobe alone.
        pdf: f32,
    }
    /// Sampled direction.
    #[derive(Default)]
    SampleResult = "hairis_sample_result" {
        /// Direction.
        wi: [f32; 3],
        /// Density.
        pdf: f32,
        /// S, linear RGB.
        value: [f32; 3],
        /// `S cos theta_i / pdf`.
        weight: [f32; 3],
        /// Slot of the lobe, -1 for a discarded sample.
        lobe: i32,
    }
    /// Columns of evaluations.
    Evals = "hairis_evals" {
        /// S.
        value: [*mut f32; 3],
        /// Densities.
        pdf: *mut f32,
    }
    /// Columns of samples.
    Samples = "hairis_samples" {
        /// Directions.
        wi: [*mut f32; 3],
        /// S.
        value: [*mut f32; 3],
        /// Densities.
        pdf: *mut f32,
        /// Weights.
        weight: [*mut f32; 3],
        /// Slots of the lobes as numbers.
        lobe: *mut f32,
    }
    /// Columns of hits.
    Hits = "hairis_hits" {
        /// Directions towards the viewer.
        wo: [*const f32; 3],
        /// Offsets across the fibre.
        h: *const f32,
        /// Indices of the materials.
        index: *const u32,
    }
    /// Columns of candidates.
    Candidates = "hairis_candidates" {
        /// Directions towards the light.
        wi: [*const f32; 3],
        /// Radiance.
        radiance: [*const f32; 3],
        /// The light's densities.
        pdf_light: *const f32,
    }
    /// Columns of weighed candidates.
    Weights = "hairis_weights" {
        /// Contributions without visibility.
        contribution: [*mut f32; 3],
        /// Weights.
        weight: *mut f32,
    }
    /// How candidates were proposed.
    Counts = "hairis_counts" {
        /// Candidates of the BSDF.
        bsdf: u32,
        /// Candidates of the light.
        light: u32,
        /// Share of the light that is estimated.
        partition: u32,
    }
    /// A candidate that was chosen.
    Choice = "hairis_choice" {
        /// Index of the candidate.
        index: usize,
        /// Number of the choices that fell on it.
        count: u32,
        /// Light that it adds if nothing is in the way, linear RGB.
        contribution: [f32; 3],
    }
}
