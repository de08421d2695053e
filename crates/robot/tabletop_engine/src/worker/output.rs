//! Output of an engine: lines for a person and marks for the worker.

use std::{io::Read, sync::mpsc::Sender};

use crate::{
    console::{Console, OutputPiece, Stream},
    kind::EngineKind,
    octave::warning_stack::WarningStack,
    worker::signal::Signal,
};

/// Reads the output of an engine until it ends.
pub(crate) fn read_output(
    mut output: impl Read,
    stream: Stream,
    kind: EngineKind,
    console: &Console,
    inbox: &Sender<Signal>,
) {
    let warns_with_places = match kind {
        EngineKind::Octave | EngineKind::Matlab => stream == Stream::Error,
        EngineKind::Python | EngineKind::Driver => false,
    };
    let mut splitter = console.splitter();
    let mut frames = WarningStack::default();
    let mut each = |piece: OutputPiece| match piece {
        OutputPiece::Text(text) if warns_with_places => {
            frames.feed(text, |line| console.push(stream, line));
        }
        OutputPiece::Text(text) => console.push(stream, text),
        OutputPiece::Mark(mark) => {
            let seq = mark.strip_prefix(b"done ").unwrap_or_default();
            let seq = str::from_utf8(seq)
                .ok()
                .and_then(|seq| seq.trim().parse().ok());
            if let Some(seq) = seq {
                drop(inbox.send(Signal::Done(seq)));
            } else if let Some(note) = mark.strip_prefix(b"note ") {
                console.push(Stream::Note, note);
            } else {
                // The script has printed the control character.
                console.push(stream, mark);
            }
        }
    };
    let mut buffer = [0; 16 << 10];
    while let Ok(count) = output.read(&mut buffer)
        && count > 0
    {
        splitter.feed(buffer.get(..count).unwrap_or_default(), &mut each);
    }
    splitter.finish(each);
    frames.finish(|line| console.push(stream, line));
    console.finish();
    drop(inbox.send(Signal::Closed));
}
