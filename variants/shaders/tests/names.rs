//! Names that users give to programs and materials, which become identifiers in every language.

use hairis::simd::trace::Target;
use hairis_shaders::{Language, Program, check_name, print};
use hairis_variants::KajiyaKay;

const ACCEPTED: [&str; 6] = ["a", "red", "dark_brown", "hair_2", "2", "a_b_c_1"];
const REJECTED: [&str; 14] = [
    "",
    "_",
    "__",
    "a__b",
    "_a",
    "a_",
    "A",
    "darkBrown",
    "a b",
    "a-b",
    "a.b",
    "\u{8336}\u{8272}",
    "caf\u{e9}",
    "a\0",
];

#[test]
fn a_name_follows_the_rules_of_every_language() {
    for name in ACCEPTED {
        assert_eq!(check_name(name), Ok(()), "{name:?}");
    }
    for name in REJECTED {
        let problem = check_name(name).expect_err(name);
        assert!(problem.ends_with(&format!("got {name:?}")), "{problem}");
    }
    assert!(check_name(&"a".repeat(255)).is_ok() && check_name(&"a".repeat(256)).is_err());
}

/// Printed identifiers are not reserved anywhere, and no two functions share a name.
#[test]
fn accepted_names_are_identifiers_of_their_own() {
    for name in ACCEPTED {
        let mut program = Program::trace::<KajiyaKay>(name, Target::Exact);
        let numbers = vec![0.5; program.material().len()];
        for material in ACCEPTED {
            program.add_material(material, &numbers);
        }
        for language in Language::ALL {
            let text = print(&program, language);
            let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
            // A module of Python is a name space of its own.
            let prefix = if language == Language::Python {
                String::new()
            } else {
                format!("hairis_{name}_")
            };
            let is_ours = |word: &&str| {
                let word = word.to_lowercase();
                word.starts_with("hairis") || word.starts_with("material_")
            };
            let ours: Vec<_> = words.filter(is_ours).collect();
            for word in &ours {
                assert!(
                    !word.contains("__") && !word.ends_with('_'),
                    "{language:?}: {word}"
                );
            }
            for material in ACCEPTED {
                let function = format!("{prefix}material_{material}");
                let found = ours.iter().filter(|word| **word == function).count();
                assert_eq!(found, 1, "{language:?}: {function}");
            }
        }
    }
}

#[test]
fn programs_and_materials_reject_other_names() {
    let program = Program::trace::<KajiyaKay>("mine", Target::Exact);
    let numbers = vec![0.5; program.material().len()];
    for name in REJECTED {
        let traces = std::panic::catch_unwind(|| Program::trace::<KajiyaKay>(name, Target::Exact));
        assert!(traces.is_err(), "{name:?}");
        let adds = std::panic::catch_unwind(|| program.clone().add_material(name, &numbers));
        assert!(adds.is_err(), "{name:?}");
    }
}
