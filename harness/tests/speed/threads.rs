//! Rows of the numbers of threads.

use hairis_harness::speed::threads::*;
use hairis_variants::ModelId;

#[test]
fn every_number_of_threads_has_its_row() {
    let counts = thread_counts();
    assert!(
        counts[0] == 1 && counts.windows(2).all(|pair| pair[0] < pair[1]),
        "{counts:?}"
    );
    let inputs = hairis_harness::speed::draw(ModelId::Gaussian, 1);
    let rows = run(ModelId::Gaussian, &inputs).expect("the default is legal");
    assert_eq!(rows.len(), 2 * counts.len(), "a row is missing");
    for row in &rows {
        assert!(
            row.millions > 0.0 && row.speedup > 0.0 && row.speedup_q1 <= row.speedup_q3,
            "{row:?}"
        );
        assert!(
            row.threads != 1 || row.speedup == 1.0,
            "one thread against itself: {row:?}"
        );
    }
}
