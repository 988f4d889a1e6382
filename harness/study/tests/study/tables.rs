//! Tables of claims in a report.

use hairis_study::study::report::tables::*;
use serde_json::json;

#[test]
fn claims_are_shown_with_their_verdicts_or_not_at_all() {
    let claim =
        json!({ "quotation": "always", "source": "5", "verdict": "false", "sentence": "not here" });
    let table =
        claims(&json!({ "claims": [claim], "machine": { "commit": "abc" } })).expect("one claim");
    let text = table.to_text(Some(u16::MAX));
    assert!(
        ["always", "(5)", "false", "not here", "commit abc"]
            .iter()
            .all(|words| text.contains(words)),
        "{text}"
    );
    for nothing in [
        json!({}),
        json!([]),
        json!({ "claims": [] }),
        json!({ "claims": 7 }),
    ] {
        assert_eq!(claims(&nothing), None, "{nothing}");
    }
}
