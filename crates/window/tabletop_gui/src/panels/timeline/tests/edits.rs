//! Edits of an open recording.

use super::*;

/// A recording in which a block is moved twice, so that two segments go together.
fn edited() -> Harness<'static, Desk> {
    let mut desk = Desk::new(TimelineStage::Open);
    let again = desk.timeline.segments[1..].to_vec();
    desk.timeline.segments.extend(again);
    for (segment, start) in desk
        .timeline
        .segments
        .iter_mut()
        .zip([100, 220, 340, 460, 580])
    {
        segment.start = SimTick(start);
    }
    harness(desk)
}

/// Selects the segment of this number.
fn select(harness: &mut Harness<Desk>, number: usize) {
    let name = format!("Segment {number}: ");
    let segment = harness.get_all_by_label_contains(&name).next();
    segment.unwrap().click();
    harness.run();
    harness.state_mut().requests.clear();
}

#[test]
fn selected_segments_are_deleted_and_change_places() {
    let mut harness = edited();
    for name in ["Earlier", "Later", "Delete"] {
        assert_eq!(click(&mut harness, name), [], "{name}: nothing is selected");
    }
    select(&mut harness, 0);
    for name in ["Earlier", "Later", "Delete"] {
        assert_eq!(click(&mut harness, name), [], "{name}: the beginning stays");
    }
    select(&mut harness, 3);
    let edit = |edit| [Request::Edit(EditOrder::Edit(edit))];
    assert_eq!(
        click(&mut harness, "Delete"),
        edit(TimelineEdit::Delete(3..=4))
    );
    assert_eq!(
        click(&mut harness, "Earlier"),
        edit(TimelineEdit::Swap(3..=4, 1..=2))
    );
    assert_eq!(click(&mut harness, "Later"), [], "there are none after it");
    select(&mut harness, 3);
    assert_eq!(
        click(&mut harness, "Later"),
        edit(TimelineEdit::Swap(3..=3, 4..=4)),
        "it alone"
    );
}

#[test]
fn the_end_of_a_selected_segment_is_dragged_to_retime_it() {
    let mut harness = edited();
    assert!(harness.query_by_label("End of segment 1").is_none());
    select(&mut harness, 1);
    let ruler = harness.get_by_label("Time").rect();
    let end = place_of(&harness, "End of segment 1");
    let per_tick = ruler.width() / 600.0;
    for (ticks, expected) in [
        (60.0, Some(180)),
        (0.0, None),
        (-500.0, Some(1)),
        (900.0, Some(1020)),
    ] {
        let to = end + vec2(ticks * per_tick, 0.0);
        harness.hover_at(end);
        harness.drag_at(end);
        harness.run();
        harness.hover_at(to);
        harness.run();
        assert_eq!(harness.state().requests, []);
        harness.drop_at(to);
        harness.run();
        let retime = |ticks| {
            let edit = TimelineEdit::Retime { segment: 1, ticks };
            Request::Edit(EditOrder::Edit(edit))
        };
        let requests = std::mem::take(&mut harness.state_mut().requests);
        assert_eq!(requests, Vec::from_iter(expected.map(retime)), "{ticks}");
    }
}

#[test]
fn edits_are_undone_redone_and_saved_but_not_while_one_is_simulated() {
    let mut harness = edited();
    let orders = [
        ("Undo edit", EditOrder::Undo),
        ("Redo edit", EditOrder::Redo),
        ("Save edits", EditOrder::Save),
    ];
    for (name, _) in &orders {
        assert_eq!(click(&mut harness, name), [], "{name}: there is nothing");
    }
    harness.state_mut().editing = Editing {
        present: None,
        undoable: 1,
        redoable: 1,
        is_unsaved: true,
    };
    harness.run();
    for (name, order) in orders.clone() {
        assert_eq!(click(&mut harness, name), [Request::Edit(order)], "{name}");
    }
    select(&mut harness, 1);
    harness.state_mut().editing.present = Some("Segment 1 is being deleted".into());
    harness.step();
    assert!(
        harness
            .query_by_label("Segment 1 is being deleted …")
            .is_some()
    );
    assert!(harness.query_by_label("End of segment 1").is_none());
    for name in orders.map(|(name, _)| name).into_iter().chain(["Delete"]) {
        harness.get_by_label(name).click();
        harness.step();
        assert_eq!(harness.state().requests, [], "{name}");
    }
}
