//! Messages that a rosbridge server has cut to pieces.

use std::collections::VecDeque;

use serde_json::Value as Json;

/// The most pieces of a message, the most bytes of all pieces, and the most messages that may lack some.
const MOST_PIECES: usize = 10_000;
const MOST_BYTES: usize = 16 << 20;
const MOST_MESSAGES: usize = 4;

/// The pieces of the messages that are not whole yet.
#[derive(Debug, Default)]
pub(super) struct Fragments {
    /// The oldest first, which gives way if there are too many.
    messages: VecDeque<Fragmented>,
}

#[derive(Debug)]
struct Fragmented {
    id: String,
    pieces: Vec<Option<String>>,
}

impl Fragmented {
    fn bytes(&self) -> usize {
        self.pieces.iter().flatten().map(String::len).sum()
    }
}

impl Fragments {
    /// Adds a piece (`"op": "fragment"`). The text of the message, once it is whole; an error if it is no piece.
    pub(super) fn add(&mut self, piece: &Json) -> Result<Option<String>, ()> {
        let text = |field: &str| piece.get(field).and_then(Json::as_str).ok_or(());
        let number = |field: &str| {
            let number = piece.get(field).and_then(Json::as_u64).ok_or(())?;
            usize::try_from(number).map_err(|_| ())
        };
        let (id, data) = (text("id")?, text("data")?);
        let (place, total) = (number("num")?, number("total")?);
        if total == 0 || total > MOST_PIECES || place >= total {
            return Err(());
        }
        let at = self.messages.iter().position(|it| it.id == id);
        let mut message = match at.and_then(|at| self.messages.remove(at)) {
            Some(message) if message.pieces.len() == total => message,
            Some(_) | None => Fragmented {
                id: id.to_owned(),
                pieces: vec![None; total],
            },
        };
        message.pieces[place] = Some(data.to_owned());
        if message.pieces.iter().all(Option::is_some) {
            return Ok(Some(message.pieces.into_iter().flatten().collect()));
        }
        self.messages.push_back(message);
        let bytes =
            |messages: &VecDeque<Fragmented>| messages.iter().map(Fragmented::bytes).sum::<usize>();
        while self.messages.len() > MOST_MESSAGES || bytes(&self.messages) > MOST_BYTES {
            self.messages.pop_front();
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    fn piece(id: &str, num: usize, total: usize, data: &str) -> Json {
        json!({"op": "fragment", "id": id, "num": num, "total": total, "data": data})
    }

    proptest! {
        #[test]
        fn pieces_in_any_order_become_the_message(order in Just((0..6usize).collect::<Vec<_>>()).prop_shuffle()) {
            let mut fragments = Fragments::default();
            for (count, place) in order.iter().enumerate() {
                let whole = fragments.add(&piece("a", *place, 6, &place.to_string())).unwrap();
                prop_assert_eq!(whole, (count == 5).then(|| "012345".to_owned()));
            }
        }
    }

    #[test]
    fn messages_do_not_mix() {
        let mut fragments = Fragments::default();
        assert_eq!(fragments.add(&piece("a", 0, 2, "x")), Ok(None));
        assert_eq!(fragments.add(&piece("b", 0, 2, "y")), Ok(None));
        assert_eq!(fragments.add(&piece("a", 1, 2, "z")), Ok(Some("xz".into())));
        assert_eq!(fragments.add(&piece("b", 1, 2, "z")), Ok(Some("yz".into())));
    }

    #[test]
    fn what_never_becomes_whole_gives_way() {
        let mut fragments = Fragments::default();
        let megabyte = "x".repeat(1 << 20);
        for message in 0..100 {
            for place in 0..8 {
                assert_eq!(
                    fragments.add(&piece(&message.to_string(), place, 9, &megabyte)),
                    Ok(None)
                );
            }
        }
        assert!(fragments.messages.len() <= MOST_MESSAGES);
        assert!(
            fragments
                .messages
                .iter()
                .map(Fragmented::bytes)
                .sum::<usize>()
                <= MOST_BYTES
        );
    }

    #[test]
    fn what_is_no_piece_is_refused() {
        let mut fragments = Fragments::default();
        for wrong in [
            piece("a", 2, 2, ""),
            piece("a", 0, 0, ""),
            piece("a", 0, 1_000_000_000, ""),
            json!({"op": "fragment", "id": "a"}),
            json!({"op": "fragment", "id": "a", "data": "", "num": -1, "total": 2}),
        ] {
            assert_eq!(fragments.add(&wrong), Err(()));
        }
    }
}
