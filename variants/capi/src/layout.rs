//! Structs and codes that both sides of the interface share. A test in C compares each of them with the header.

use core::ffi::c_char;

/// Layout that a struct must have for the C compiler.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name of the struct in the header.
    pub name: &'static str,
    /// Size in bytes.
    pub size: usize,
    /// Alignment in bytes.
    pub align: usize,
    /// Name, offset and size of each field.
    pub fields: &'static [(&'static str, usize, usize)],
}

/// Declares the structs of the C interface, and the table of their layouts.
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

        /// Layout of every struct of the header, for the test that compares them.
        pub const LAYOUTS: &[Layout] = &[$(Layout {
            name: $c,
            size: size_of::<$name>(),
            align: align_of::<$name>(),
            fields: &[$((stringify!($field), core::mem::offset_of!($name, $field), size_of::<$type>())),*],
        }),*];
    };
}

/// Declares the constants of the C interface, and the table of their names and values.
macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident: $type:ty = $value:expr, $c:literal;)*) => {
        $($(#[$doc])* pub const $name: $type = $value;)*

        /// Name and value of every constant of the header, for the test that compares them.
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
    NUMBERS: usize = 48, "HAIRIS_NUMBERS";
    /// Slots of lobes.
    LOBES: usize = 5, "HAIRIS_LOBES";
    /// Status of a call that succeeded.
    OK: i32 = 0, "HAIRIS_OK";
    /// Status if there is no such model, choice, preset, field or word.
    NAME: i32 = 1, "HAIRIS_NAME";
    /// Status if a value is out of its range, or if a field has another count of numbers.
    VALUE: i32 = 2, "HAIRIS_VALUE";
    /// Status if a pointer is null, a code is unknown, a handle is not of the library or an index is out of range.
    ARGUMENT: i32 = 3, "HAIRIS_ARGUMENT";
    /// Energy of the model as it is.
    ENERGY_RAW: u32 = 0, "HAIRIS_ENERGY_RAW";
    /// Energy limited to the light that arrives, direction by direction.
    ENERGY_CONSERVING: u32 = 1, "HAIRIS_ENERGY_CONSERVING";
    /// Energy limited to the light that arrives, by one factor on all colours.
    ENERGY_SCALED: u32 = 2, "HAIRIS_ENERGY_SCALED";
    /// Shape of a field with one number.
    KIND_NUMBER: u32 = 0, "HAIRIS_KIND_NUMBER";
    /// Shape of a field with several numbers, each with a label.
    KIND_NUMBERS: u32 = 1, "HAIRIS_KIND_NUMBERS";
    /// Shape of a field with a linear RGB colour.
    KIND_RGB: u32 = 2, "HAIRIS_KIND_RGB";
    /// Shape of a field with a word of a list.
    KIND_WORD: u32 = 3, "HAIRIS_KIND_WORD";
    /// Partition in which resampling estimates all light.
    PARTITION_ALL: u32 = 0, "HAIRIS_PARTITION_ALL";
    /// Partition in which resampling estimates the light technique's share by the balance heuristic.
    PARTITION_BALANCE: u32 = 1, "HAIRIS_PARTITION_BALANCE";
    /// Partition in which resampling estimates the light technique's share by the power heuristic.
    PARTITION_POWER: u32 = 2, "HAIRIS_PARTITION_POWER";
}

/// Bytes of the head of a handle, which precede its constants.
pub const HEAD_SIZE: usize = 16;

structs! {
    /// Error that a call of set-up reports.
    Error = "hairis_error" {
        /// Status that the call returned.
        code: i32,
        /// Place of the number at fault in its field, or -1.
        number: i32,
        /// Value at fault.
        value: f32,
        /// Field at fault.
        field: [c_char; 32],
        /// Sentence for users.
        message: [c_char; 212],
    }
    /// Entry of the list of models, as a host's interface presents it.
    ModelInfo = "hairis_model_info" {
        /// Name of the model.
        name: [c_char; 32],
        /// Field that selects among the entries of one name.
        choice: [c_char; 32],
        /// Word of that field that selects this entry.
        word: [c_char; 32],
        /// Names of the lobes, by slot.
        lobe_names: [[c_char; 16]; LOBES],
        /// Number of lobes.
        lobes: u32,
        /// Number of fields.
        fields: u32,
        /// Number of presets.
        presets: u32,
        /// Flag: 1 if the model reads `h`, otherwise 0.
        near_field: u32,
        /// Flag: 1 if the entry is the first of its name, otherwise 0.
        is_default: u32,
    }
    /// Field of a model's parameters, as a host's interface presents it.
    FieldInfo = "hairis_field_info" {
        /// Name of the field.
        name: [c_char; 32],
        /// Field that this field may take the place of, or an empty string.
        instead_of: [c_char; 32],
        /// Shape of the value.
        kind: u32,
        /// Count of numbers.
        width: u32,
        /// Place of the first number among all numbers of the parameters.
        first: u32,
        /// Flag: 1 if files may leave the field out, otherwise 0.
        optional: u32,
        /// Smallest number that is accepted.
        least: f32,
        /// Largest number that is accepted.
        most: f32,
        /// Count of labels.
        labels: u32,
        /// Words of the field, or a label for each number.
        label: [[c_char; 16]; 4],
        /// Unit of the numbers: "rad", or an empty string.
        unit: [c_char; 8],
        /// Sentence for users.
        doc: [c_char; 128],
    }
    /// Values of the fields of a model.
    Params = "hairis_params" {
        /// Index of the model.
        model: u32,
        /// Bit `i` is set if field `i` has a value.
        given: u32,
        /// Numbers of all fields, in their order.
        numbers: [f32; NUMBERS],
    }
    /// Highlight in an artist's terms.
    Highlight = "hairis_highlight" {
        /// Colour, linear RGB.
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
        /// Colour, linear RGB.
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
        /// Tag of the model, and 1 for a material without energy conservation or 0.
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
    /// Value and density of a direction.
    #[derive(Default)]
    EvalResult = "hairis_eval_result" {
        /// S without the cosine, linear RGB.
        value: [f32; 3],
        /// Density per steradian.
        pdf: f32,
    }
    /// Value, colour and density of one lobe at a direction.
    #[derive(Default)]
    LobeResult = "hairis_lobe_result" {
        /// The lobe's part of S without its colour.
        value: f32,
        /// Colour, linear RGB.
        color: [f32; 3],
        /// Density of the lobe alone.
        pdf: f32,
    }
    /// Sampled direction with its density, value and weight.
    #[derive(Default)]
    SampleResult = "hairis_sample_result" {
        /// Direction towards the light.
        wi: [f32; 3],
        /// Density per steradian.
        pdf: f32,
        /// S without the cosine, linear RGB.
        value: [f32; 3],
        /// Throughput weight `S cos theta_i / pdf`.
        weight: [f32; 3],
        /// Slot of the lobe, -1 for a discarded sample.
        lobe: i32,
    }
    /// Averages of a material for dual scattering.
    DualScattering = "hairis_dual" {
        /// Coefficients by quantity, channel and power.
        coefficients: [[[f32; 10]; 3]; 8],
    }
    /// Light that has crossed fibres.
    #[derive(Default)]
    Crossed = "hairis_crossed" {
        /// Share of the light that has crossed no fibre.
        direct: f32,
        /// Share of the light that fibres have scattered forward.
        scattered: [f32; 3],
        /// Mean shift of its inclination, rad.
        shift: [f32; 3],
        /// Variance of its inclination, rad^2.
        variance: [f32; 3],
    }
    /// Columns of evaluations.
    Evals = "hairis_evals" {
        /// S by component, linear RGB.
        value: [*mut f32; 3],
        /// Densities.
        pdf: *mut f32,
    }
    /// Columns of samples.
    Samples = "hairis_samples" {
        /// Directions towards the light.
        wi: [*mut f32; 3],
        /// S by component, linear RGB.
        value: [*mut f32; 3],
        /// Densities.
        pdf: *mut f32,
        /// Throughput weights by component, linear RGB.
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
    /// Columns of candidates for resampling.
    Candidates = "hairis_candidates" {
        /// Directions towards the light.
        wi: [*const f32; 3],
        /// Radiance from each direction, linear RGB.
        radiance: [*const f32; 3],
        /// Densities with which the light samples the directions.
        pdf_light: *const f32,
    }
    /// Columns of weighed candidates.
    Weights = "hairis_weights" {
        /// Contributions without visibility, linear RGB.
        contribution: [*mut f32; 3],
        /// Weights by which candidates are chosen.
        weight: *mut f32,
    }
    /// Counts of the candidates that each technique proposed.
    Counts = "hairis_counts" {
        /// Candidates that the BSDF proposed.
        bsdf: u32,
        /// Candidates that the light proposed.
        light: u32,
        /// Share of the light that resampling estimates.
        partition: u32,
    }
    /// Candidate that was chosen, with the number of its choices.
    Choice = "hairis_choice" {
        /// Index of the candidate.
        index: usize,
        /// Number of choices that fell on the candidate.
        count: u32,
        /// Light that the candidate adds if nothing occludes it, linear RGB.
        contribution: [f32; 3],
    }
}
