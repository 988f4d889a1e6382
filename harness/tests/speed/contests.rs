//! Contenders and their answers.

use hairis_benches::contenders::{Contest, TIMED_DIRECTIONS, contests};
use hairis_harness::speed::*;
use hairis_variants::ModelId;

fn kajiya_kay() -> Vec<Contest> {
    contests(ModelId::KajiyaKay, &draw(ModelId::KajiyaKay, 1)).expect("accepted")
}

#[test]
fn every_contender_answers_every_direction() {
    for Contest {
        op,
        contenders,
        truth,
        ..
    } in [ModelId::KajiyaKay, ModelId::Gaussian]
        .iter()
        .flat_map(|model| contests(*model, &draw(*model, 1)).expect("accepted"))
    {
        for mut contender in contenders {
            let wrong = truth.wrong_share(&contender.task.answers(), contender.conserves);
            assert!(
                wrong <= MAX_WRONG,
                "{} {} {}: {wrong}",
                op.label(),
                contender.name,
                contender.level
            );
        }
    }
}

#[test]
fn one_wrong_lane_in_eight_fails() {
    let Contest {
        contenders, truth, ..
    } = kajiya_kay()
        .into_iter()
        .find(|contest| contest.op == TimedOp::EvalPdf)
        .expect("among all");
    let mut eight = contenders
        .into_iter()
        .find(|contender| contender.name == "eight lanes")
        .expect("among all");
    let mut answers = eight.task.answers();
    assert!(
        truth.wrong_share(&answers, false) <= MAX_WRONG,
        "right answers"
    );
    for answer in answers.iter_mut().step_by(8) {
        answer.pdf = answer.pdf.map(|pdf| 1.01 * pdf);
    }
    assert!(
        truth.wrong_share(&answers, false) >= 0.12,
        "a wrong density passed"
    );
    answers.truncate(TIMED_DIRECTIONS - 1);
    assert_eq!(
        truth.wrong_share(&answers, false),
        1.0,
        "an answer is missing"
    );
}
