//! Streams of requests that are long, slow, short or broken.

use super::{PATHS, command, eval, good, run};
use core::time::Duration;
use std::io::{BufRead, BufReader, Read, Write};
use std::sync::mpsc;
use std::thread;

#[test]
fn no_input_is_no_output() {
    for path in PATHS {
        let run = run(&["eval", "--path", path], b"");
        assert_eq!(
            (run.code, run.out.len(), run.err.len()),
            (Some(0), 0, 0),
            "{path}: {:?}",
            run.err
        );
    }
}

#[test]
fn a_last_line_needs_no_end() {
    let text = good().to_string();
    for (end, lines) in [("", 2), ("\n", 2), ("\n\n", 3)] {
        let run = run(&["eval"], format!("{text}\n{text}{end}").as_bytes());
        assert_eq!(run.out.len(), lines, "input that ends with {end:?}");
    }
}

#[test]
fn byte_order_marks_cost_no_line() {
    let text = good().to_string();
    for path in PATHS {
        let expected = run(&["eval", "--path", path], text.as_bytes()).out;
        // One file, then two that were joined.
        let input = format!("\u{feff}{text}\r\n{text}\r\n\u{feff}{text}\r\n");
        let run = run(&["eval", "--path", path], input.as_bytes());
        assert_eq!(run.code, Some(0), "{path}: {:?}", run.out);
        assert_eq!(
            run.out,
            [&expected[..], &expected, &expected].concat(),
            "{path}"
        );
    }
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let input = format!("{}\n", good()).repeat(20_000);
    for path in PATHS {
        let mut child = command(&["eval", "--path", path]).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let input = input.clone();
        // The run stops reading, so that this write may fail.
        let writer = thread::spawn(move || drop(stdin.write_all(input.as_bytes())));
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut first)
            .unwrap();
        assert!(first.starts_with("{\"s\":["), "{path}: {first}");
        let mut err = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut err)
            .unwrap();
        assert_eq!(
            (child.wait().unwrap().code(), &*err),
            (Some(0), ""),
            "{path}"
        );
        writer.join().unwrap();
    }
}

#[test]
fn who_waits_for_an_answer_gets_it() {
    for path in PATHS {
        let mut child = command(&["eval", "--path", path]).spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let stdout = BufReader::new(child.stdout.take().unwrap());
        let (sender, answers) = mpsc::channel();
        let reader = thread::spawn(move || {
            stdout
                .lines()
                .for_each(|line| sender.send(line.unwrap()).unwrap())
        });
        for i in 0..3 {
            writeln!(stdin, "{}", good()).unwrap();
            stdin.flush().unwrap();
            let answer = answers.recv_timeout(Duration::from_secs(60));
            assert!(
                answer.is_ok(),
                "{path}: no answer to line {i} while the input is open"
            );
        }
        drop(stdin);
        assert_eq!(child.wait().unwrap().code(), Some(0), "{path}");
        reader.join().unwrap();
    }
}

#[test]
fn numbers_are_as_short_as_their_precision_allows() {
    for path in PATHS {
        let line = eval(path, &[good()]).out.remove(0);
        let (_, rest) = line.split_once("\"pdf\":").unwrap();
        let (pdf, _) = rest.split_once(',').unwrap();
        let shortest = match path {
            "f64" => serde_json::to_string(&pdf.parse::<f64>().unwrap()),
            _ => serde_json::to_string(&pdf.parse::<f32>().unwrap()),
        };
        assert_eq!(pdf, shortest.unwrap(), "{path}: {line}");
    }
}
