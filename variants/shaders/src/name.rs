//! Names of programs and materials, which become parts of identifiers in every language.

/// Number of characters of the longest name, so that whole identifiers stay below the 1024 characters of GLSL ES.
const LONGEST: usize = 255;

/// Checks a name of a program or material against the rules of every language at once: ASCII letters in lower case and digits in words
/// with one underscore between them.
///
/// GLSL, C++ and what derives from it reserve every identifier with two underscores in a row, WGSL reserves some, and names of types are
/// the words with a capital each, so that capitals and underscores at the ends would make two names one.
///
/// # Errors
///
/// Returns an error with the name if it breaks a rule.
///
/// # Examples
///
/// ```
/// assert!(hairis_shaders::check_name("dark_brown_2").is_ok());
/// assert!(hairis_shaders::check_name("dark__brown").is_err());
/// ```
pub fn check_name(name: &str) -> Result<(), String> {
    let is_word = |word: &str| {
        let mut letters = word.bytes();
        !word.is_empty() && letters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    };
    if name.len() <= LONGEST && name.split('_').all(is_word) {
        return Ok(());
    }
    Err(format!(
        "name must be words of the letters a to z and digits, with one underscore between words and at most {LONGEST} characters, \
         got {name:?}"
    ))
}
