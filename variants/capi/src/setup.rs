//! Calls of set-up, which report errors in a sentence: models by name, parameters by field, and materials.

use crate::handles::{init, material, model_of};
use crate::layout::{
    ABI_VERSION, ARGUMENT, ENERGY_CONSERVING, ENERGY_RAW, ENERGY_SCALED, Error, FieldInfo,
    KIND_NUMBER, KIND_NUMBERS, KIND_RGB, KIND_WORD, LOBES, ModelInfo, NAME, NUMBERS, OK, Params,
    RawMaterial, VALUE,
};
use crate::models::{self, Subject, visit};
use crate::text::{Fault, List, array, copy, refuse, string};
use core::ffi::c_char;
use hairis::ParamError;
use hairis::simd::Level;
use hairis_variants::chiang::{Chiang, Likeness};
use hairis_variants::{FieldError, Kind, ModelId, Values};

const _: () = assert!(
    NUMBERS == Values::MOST,
    "the header has room for all numbers"
);

/// Converts a count to the type of the header; no count is above 32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a few fields, words and lobes"
)]
const fn count(number: usize) -> u32 {
    number as u32
}

/// Implements `hairis_abi_version`: returns the version of the interface.
#[unsafe(no_mangle)]
pub extern "C" fn hairis_abi_version() -> u32 {
    ABI_VERSION
}

/// Implements `hairis_version`: returns the version of the library as text.
#[unsafe(no_mangle)]
pub extern "C" fn hairis_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Implements `hairis_level_name`: copies the name of the instruction set that calls run on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_level_name(to: *mut c_char, size: usize) -> usize {
    // SAFETY: the caller's promise.
    unsafe { copy(Level::detect().name(), to, size) }
}

/// Implements `hairis_model_count`: returns the number of models.
#[unsafe(no_mangle)]
pub extern "C" fn hairis_model_count() -> u32 {
    count(ModelId::ALL.len())
}

/// Implements `hairis_model_describe`: describes the model of an index.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_model_describe(model: u32, to: *mut ModelInfo) -> i32 {
    let (Some(subject), false) = (Subject::at(model), to.is_null()) else {
        return ARGUMENT;
    };
    let id = subject.id;
    let (choice, word) = id.choice().unwrap_or_default();
    let mut lobe_names = [[0; 16]; LOBES];
    for (to, name) in lobe_names.iter_mut().zip(id.lobes()) {
        *to = array(name);
    }
    let info = ModelInfo {
        name: array(id.name()),
        choice: array(choice),
        word: array(word),
        lobe_names,
        lobes: count(id.lobes().len()),
        fields: count(subject.fields().len()),
        presets: count(id.presets().count()),
        near_field: id.is_near_field().into(),
        is_default: id.is_default().into(),
    };
    // SAFETY: the caller's promise.
    unsafe { to.write(info) };
    OK
}

/// Implements `hairis_field_describe`: describes a field of a model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_field_describe(model: u32, field: u32, to: *mut FieldInfo) -> i32 {
    let fields = Subject::at(model).map_or(&[][..], Subject::fields);
    let index = usize::try_from(field).unwrap_or(usize::MAX);
    let (Some(field), false) = (fields.get(index), to.is_null()) else {
        return ARGUMENT;
    };
    let (kind, labels) = match field.kind {
        Kind::Number => (KIND_NUMBER, &[][..]),
        Kind::Numbers(labels) => (KIND_NUMBERS, labels),
        Kind::Rgb => (KIND_RGB, &[][..]),
        Kind::Word(words) => (KIND_WORD, words),
    };
    let mut label = [[0; 16]; 4];
    for (to, name) in label.iter_mut().zip(labels) {
        *to = array(name);
    }
    let [least, most] = field.range().unwrap_or_default();
    let info = FieldInfo {
        name: array(field.name),
        instead_of: array(field.instead_of.unwrap_or_default()),
        kind,
        width: count(field.kind.width()),
        first: count(fields[..index].iter().map(|field| field.kind.width()).sum()),
        optional: field.optional.into(),
        least,
        most,
        labels: count(labels.len()),
        label,
        unit: array(field.unit),
        doc: array(field.doc),
    };
    // SAFETY: the caller's promise.
    unsafe { to.write(info) };
    OK
}

/// Implements `hairis_preset_name`: copies the name of a preset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_preset_name(
    model: u32,
    preset: u32,
    to: *mut c_char,
    size: usize,
) -> usize {
    let index = usize::try_from(preset).unwrap_or(usize::MAX);
    let name = models::at(model).and_then(|id| Some(id.presets().nth(index)?.0));
    // SAFETY: the caller's promise.
    name.map_or(0, |name| unsafe { copy(name, to, size) })
}

/// Returns the values of a model's fields as parameters of the C interface.
#[must_use]
pub fn params_of(id: ModelId, values: &Values) -> Params {
    params_at(id as u32, values)
}

/// Returns the values of fields as parameters of the C interface; `index` is that of the [`Subject`].
fn params_at(index: u32, values: &Values) -> Params {
    let mut params = Params {
        model: index,
        given: 0,
        numbers: [0.0; NUMBERS],
    };
    let mut rest = &mut params.numbers[..];
    for index in 0..values.fields().len() {
        let numbers = values.numbers_at(index);
        let (to, after) = rest.split_at_mut(numbers.len());
        to.copy_from_slice(numbers);
        rest = after;
        params.given |= u32::from(values.has_at(index)) << index;
    }
    params
}

/// Returns the subject of parameters, and the values of its fields.
unsafe fn read(params: *const Params, error: *mut Error) -> Result<(Subject, Values), i32> {
    // SAFETY: the caller's promise: null, or parameters.
    let params = unsafe { params.as_ref() };
    let known = params.and_then(|params| Some((params, Subject::at(params.model)?)));
    let Some((params, subject)) = known.filter(|(params, _)| params.given != 0) else {
        let message = &"the parameters must be made by hairis_params_init";
        // SAFETY: the caller's promise.
        return Err(unsafe { refuse(error, ARGUMENT, &Fault::of("params"), message) });
    };
    let mut values = Values::none(subject.fields());
    let mut rest = &params.numbers[..];
    for (index, field) in subject.fields().iter().enumerate() {
        let (numbers, after) = rest.split_at(field.kind.width());
        rest = after;
        if params.given >> index & 1 == 1 {
            // The field has this index and this count.
            let _ = values.set_at(index, numbers);
        }
    }
    Ok((subject, values))
}

/// Returns the model of parameters, and the values of its own fields.
///
/// # Errors
///
/// Returns the status code if the parameters were not initialised, or if those of another renderer describe no fibre, and writes the reason
/// to `error` unless that is null.
pub unsafe fn values_of(
    params: *const Params,
    error: *mut Error,
) -> Result<(ModelId, Values), i32> {
    // SAFETY: the caller's promise.
    let (subject, values) = unsafe { read(params, error) }?;
    // SAFETY: the caller's promise.
    let refuse = |fault| unsafe { refuse_value(error, &fault) };
    subject.own(values).map_err(refuse)
}

/// Returns parameters of Chiang's fibre in the terms of another renderer, or `None` if the list has no such renderer.
#[must_use]
pub fn params_like(renderer: &str) -> Option<Params> {
    let (place, like) = (0..)
        .zip(Likeness::ALL)
        .find(|(_, like)| like.name == renderer)?;
    let index = Subject::index_like(ModelId::of::<Chiang>(), place);
    Some(params_at(index, &like.defaults()))
}

/// Implements `hairis_params_like`: initialises parameters of Chiang's fibre in the terms of another renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_like(
    to: *mut Params,
    renderer: *const c_char,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    let (name, to) = unsafe { (string(renderer).unwrap_or_default(), to.as_mut()) };
    let (Some(params), Some(to)) = (params_like(name), to) else {
        let names = List(Likeness::ALL.iter().map(|like| like.name));
        let message =
            &format_args!("renderer must be one of {names}, and to not NULL; got {name:?}");
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, NAME, &Fault::of("renderer"), message) };
    };
    *to = params;
    OK
}

/// Implements `hairis_params_init`: initialises parameters from a preset or from the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_init(
    to: *mut Params,
    model: *const c_char,
    choice: *const c_char,
    preset: *const c_char,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    let (model, word, preset) = unsafe { (string(model), string(choice), string(preset)) };
    // SAFETY: the caller's promise.
    let refuse = |code, field, message: &dyn core::fmt::Display| unsafe {
        refuse(error, code, &Fault::of(field), message)
    };
    let (Some(name), false) = (model, to.is_null()) else {
        return refuse(ARGUMENT, "model", &"to and model must not be NULL");
    };
    let Some(first) = ModelId::find(name, None) else {
        let names = List(ModelId::defaults_of_names().map(ModelId::name));
        return refuse(
            NAME,
            "model",
            &format_args!("model must be one of {names}, got {name:?}"),
        );
    };
    let Some(id) = ModelId::find(name, word) else {
        let of_name = ModelId::ALL.iter().filter(|id| id.name() == first.name());
        let words = List(of_name.filter_map(|id| Some(id.choice()?.1)));
        let (field, word) = (
            first.choice().map_or("choice", |(field, _)| field),
            word.unwrap_or_default(),
        );
        return match first.choice() {
            Some(_) => refuse(
                NAME,
                field,
                &format_args!("{field} must be one of {words}, got {word:?}"),
            ),
            None => refuse(
                NAME,
                field,
                &format_args!("choice must be NULL for {name}, got {word:?}"),
            ),
        };
    };
    let values = match preset {
        None => Some(id.defaults()),
        Some(preset) => id
            .presets()
            .find(|(one, _)| *one == preset)
            .map(|(_, values)| values),
    };
    let Some(values) = values else {
        let (names, preset) = (
            List(id.presets().map(|(name, _)| name)),
            preset.unwrap_or_default(),
        );
        return refuse(
            NAME,
            "preset",
            &format_args!("preset must be one of {names}, got {preset:?}"),
        );
    };
    // SAFETY: the caller's promise.
    unsafe { to.write(params_of(id, &values)) };
    OK
}

/// Sets a field to the value `got` by calling `set`, and writes the parameters unless `set` returns an error.
unsafe fn set(
    params: *mut Params,
    field: *const c_char,
    error: *mut Error,
    got: &dyn core::fmt::Display,
    set: impl Fn(&mut Values, &str) -> Result<(), FieldError>,
) -> i32 {
    // SAFETY: the caller's promise.
    let (name, read) = unsafe { (string(field).unwrap_or_default(), read(params, error)) };
    let (subject, mut values) = match read {
        Ok(read) => read,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    let refuse = |code, message: &dyn core::fmt::Display| unsafe {
        refuse(error, code, &Fault::of(name), message)
    };
    match set(&mut values, name) {
        Ok(()) => {
            // SAFETY: the caller's promise.
            unsafe { (*params) = params_at((*params).model, &values) };
            OK
        }
        Err(FieldError::Name) => {
            let names = List(subject.fields().iter().map(|field| field.name));
            refuse(
                NAME,
                &format_args!("field must be one of {names}, got {name:?}"),
            )
        }
        Err(FieldError::Count(width)) => refuse(
            VALUE,
            &format_args!("{name} must be {width} numbers, got {got}"),
        ),
        Err(FieldError::Word([])) => refuse(
            VALUE,
            &format_args!("{name} must be numbers, got {got}: use hairis_params_set"),
        ),
        Err(FieldError::Word(words)) => {
            let words = List(words.iter().copied());
            refuse(
                NAME,
                &format_args!("{name} must be one of {words}, got {got}"),
            )
        }
        Err(error) => refuse(VALUE, &format_args!("{name}: {error}")),
    }
}

/// Implements `hairis_params_set`: sets the numbers of a field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_set(
    params: *mut Params,
    field: *const c_char,
    numbers: *const f32,
    count: usize,
    error: *mut Error,
) -> i32 {
    if numbers.is_null() || count > NUMBERS {
        let got: &dyn core::fmt::Display = if numbers.is_null() { &"NULL" } else { &count };
        let message = &format_args!("numbers must be at most {NUMBERS} and not NULL, got {got}");
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, ARGUMENT, &Fault::of("numbers"), message) };
    }
    // SAFETY: the caller's promise.
    unsafe {
        let numbers = core::slice::from_raw_parts(numbers, count);
        set(
            params,
            field,
            error,
            &format_args!("{count} numbers"),
            |values, name| {
                let index = values.index(name).ok_or(FieldError::Name)?;
                match values.fields()[index].kind {
                    Kind::Word(words) => Err(FieldError::Word(words)),
                    _ => values.set_at(index, numbers),
                }
            },
        )
    }
}

/// Implements `hairis_params_set_word`: sets the word of a field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_set_word(
    params: *mut Params,
    field: *const c_char,
    word: *const c_char,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    unsafe {
        let word = string(word).unwrap_or_default();
        set(
            params,
            field,
            error,
            &format_args!("{word:?}"),
            |values, name| values.set_word(name, word),
        )
    }
}

/// Writes the error of a value out of its range, and returns its status code.
pub(crate) unsafe fn refuse_value(error: *mut Error, fault: &ParamError) -> i32 {
    let place = Fault {
        field: fault.field(),
        number: fault.number(),
        value: fault.value(),
    };
    // SAFETY: the caller's promise.
    unsafe { refuse(error, VALUE, &place, fault) }
}

/// Implements `hairis_material_init`: makes a material from parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_material_init(
    to: *mut RawMaterial,
    params: *const Params,
    energy: u32,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    let (id, values) = match unsafe { values_of(params, error) } {
        Ok(read) => read,
        Err(code) => return code,
    };
    if to.is_null() || !matches!(energy, ENERGY_RAW | ENERGY_CONSERVING | ENERGY_SCALED) {
        let got: &dyn core::fmt::Display = if to.is_null() { &"NULL" } else { &energy };
        let message = &format_args!("energy must be 0, 1 or 2, and to not NULL; got {got}");
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, ARGUMENT, &Fault::of("energy"), message) };
    }
    if !to.is_aligned() {
        let message = &format_args!("to must lie at a multiple of 16 bytes, got {to:p}");
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, ARGUMENT, &Fault::of("to"), message) };
    }
    // SAFETY: the caller's promise.
    match unsafe { init(to, id, &values, energy) } {
        // SAFETY: the caller's promise.
        Err(fault) => unsafe { refuse_value(error, &fault) },
        Ok(()) => OK,
    }
}

/// Implements `hairis_material_max_albedo`: returns the largest directional albedo of a material.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_material_max_albedo(from: *const RawMaterial) -> f32 {
    // SAFETY: the caller's promise.
    let id = unsafe { model_of(from) };
    let max = id.map(|id| {
        visit!(id, M, (from: *const RawMaterial) -> f32, {
            // SAFETY: the tag is the model's.
            unsafe { material::<M>(from) }.raw().max_albedo()
        })
    });
    max.unwrap_or(0.0)
}
