//! The keyboard's focus. egui takes the keyboard as soon as anything has been clicked or reached with Tab; here only a text field in use, and
//! an overlay, take it, so that keys work anytime (report section 2.4), and only on what is in front.

use bevy::{
    input::{InputSystems, keyboard::KeyboardInput},
    prelude::*,
};
use bevy_egui::{
    EguiContext, EguiInput, EguiPostUpdateSet, EguiPreUpdateSet, egui,
    helpers::bevy_to_egui_physical_key,
};
use tabletop_user::{Chosen, KeyLetters, KeyboardFocus, Keys};

/// A context that takes all keys: there is nothing else for which they could be.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct TakesKeys;

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<KeyboardInput>()
        .add_systems(
            PreUpdate,
            (
                learn_letters.after(InputSystems),
                (go_to_panels, keep_bound_keys_from_panels)
                    .chain()
                    .after(EguiPreUpdateSet::ProcessInput)
                    .before(EguiPreUpdateSet::BeginPass),
            )
                .chain(),
        )
        .add_systems(
            PostUpdate,
            follow_panels.in_set(EguiPostUpdateSet::ProcessOutput),
        );
}

fn learn_letters(mut input: MessageReader<KeyboardInput>, mut letters: ResMut<KeyLetters>) {
    let pressed = input.read().filter(|input| input.state.is_pressed());
    pressed.for_each(|input| letters.learn(input));
}

fn follow_panels(
    mut contexts: Query<(&mut EguiContext, Has<TakesKeys>)>,
    mut focus: ResMut<KeyboardFocus>,
) {
    let of_contexts = contexts
        .iter_mut()
        .map(|(mut context, takes_keys)| match takes_keys {
            true => KeyboardFocus::Text,
            false => focus_of(context.get_mut()),
        });
    focus.set_if_neq(of_contexts.max().unwrap_or_default());
}

fn focus_of(context: &egui::Context) -> KeyboardFocus {
    let is_modal = context.memory(|memory| memory.top_modal_layer().is_some());
    if context.text_edit_focused() {
        KeyboardFocus::Text
    } else if is_modal || context.any_popup_open() {
        KeyboardFocus::Overlay
    } else {
        KeyboardFocus::World
    }
}

/// A key that does something does nothing else: Space does not click the button that has the focus, arrows do not move its knob.
fn keep_bound_keys_from_panels(
    keys: Keys,
    input: Res<ButtonInput<KeyCode>>,
    mut panels: Query<&mut EguiInput>,
) {
    let bound = input
        .get_pressed()
        .chain(input.get_just_pressed())
        .filter(|key| keys.meaning(**key).is_some());
    let bound: Vec<_> = bound.filter_map(bevy_to_egui_physical_key).collect();
    for mut panels in &mut panels {
        panels.events.retain(|event| !is_press_of(event, &bound));
    }
}

/// Ctrl+Tab goes from widget to widget, as Tab does elsewhere: here Tab goes from object to object. Then keys are the panels'.
fn go_to_panels(mut panels: Query<&mut EguiInput>, mut chosen: ResMut<Chosen>) {
    for mut panels in &mut panels {
        let gone = panels.events.iter_mut().filter_map(plain_tab).count();
        if gone > 0 {
            chosen.set_if_neq(Chosen(None));
        }
    }
}

/// Makes Ctrl+Tab plain.
fn plain_tab(event: &mut egui::Event) -> Option<()> {
    let egui::Event::Key {
        key: egui::Key::Tab,
        pressed: true,
        modifiers,
        ..
    } = event
    else {
        return None;
    };
    modifiers.ctrl.then(|| {
        *modifiers = egui::Modifiers {
            shift: modifiers.shift,
            ..egui::Modifiers::NONE
        };
    })
}

fn is_press_of(event: &egui::Event, keys: &[egui::Key]) -> bool {
    matches!(
        event,
        egui::Event::Key { physical_key: Some(key), pressed: true, .. } if keys.contains(key)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use KeyCode::{ArrowRight, Digit1, Digit2, Enter, Escape, F1, KeyR, Space, Tab};
    use tabletop_core::CorePlugin;
    use tabletop_user::{Action, KeySystems, Keymap, UserPlugin};

    /// A form with things that can have the focus, and the results.
    #[derive(Resource, Default)]
    struct Form {
        focus: Option<Widget>,
        clicks: u32,
        slider: f32,
        number: i32,
        text: String,
        is_list_open: bool,
    }

    #[derive(Clone, Copy, PartialEq)]
    enum Widget {
        Button,
        Slider,
        Number,
        Text,
        List,
    }

    #[derive(Resource, Default)]
    struct Struck(Vec<Action>);

    fn draw(panel: Single<(&mut EguiContext, &mut EguiInput)>, mut form: ResMut<Form>) {
        let (mut context, mut input) = panel.into_inner();
        let form = &mut *form;
        let _output = context.get_mut().run_ui(input.take(), |ui| {
            let button = ui.button("a button");
            form.clicks += u32::from(button.clicked());
            let slider = ui.add(egui::Slider::new(&mut form.slider, 0.0..=1.0));
            let number = ui.add(egui::DragValue::new(&mut form.number));
            let text = ui.text_edit_singleline(&mut form.text);
            let list = egui::ComboBox::from_label("a list").show_ui(ui, |ui| {
                let _choice = ui.selectable_label(false, "a choice");
            });
            form.is_list_open = list.inner.is_some();
            match form.focus.take() {
                None => {}
                Some(Widget::Button) => button.request_focus(),
                Some(Widget::Slider) => slider.request_focus(),
                Some(Widget::Number) => number.request_focus(),
                Some(Widget::Text) => text.request_focus(),
                Some(Widget::List) => list.response.request_focus(),
            }
        });
    }

    fn note_struck(keys: Keys, keymap: Res<Keymap>, mut struck: ResMut<Struck>) {
        let all = keymap.actions();
        struck
            .0
            .extend(all.filter(|action| keys.was_struck(*action)));
    }

    struct Keyboard {
        app: App,
    }

    impl Keyboard {
        fn new() -> Self {
            let mut app = App::new();
            app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
                .init_resource::<ButtonInput<KeyCode>>()
                .init_resource::<Form>()
                .init_resource::<Struck>()
                .add_systems(RunFixedMainLoop, note_struck.in_set(KeySystems))
                .add_systems(PostUpdate, draw.before(follow_panels));
            app.world_mut()
                .spawn((EguiContext::default(), EguiInput::default()));
            app.update();
            Self { app }
        }

        /// A widget has the focus, for longer than a frame.
        fn with_focus_on(widget: Widget) -> Self {
            let mut keyboard = Self::new();
            keyboard.app.world_mut().resource_mut::<Form>().focus = Some(widget);
            for _ in 0..3 {
                keyboard.app.update();
            }
            assert!(keyboard.has_egui());
            keyboard
        }

        /// True if egui would take the keys for itself.
        fn has_egui(&mut self) -> bool {
            let world = self.app.world_mut();
            let mut contexts = world.query::<&mut EguiContext>();
            let mut context = contexts.single_mut(world).unwrap();
            context.get_mut().egui_wants_keyboard_input()
        }

        fn event(&mut self, event: egui::Event) {
            let world = self.app.world_mut();
            let mut panels = world.query::<&mut EguiInput>();
            panels.single_mut(world).unwrap().events.push(event);
        }

        /// The actions that follow when a key goes down and up, as the window reports it.
        fn strike(&mut self, key: KeyCode, text: &str) -> Vec<Action> {
            for pressed in [true, false] {
                if let Some(key) = bevy_to_egui_physical_key(&key) {
                    self.event(egui::Event::Key {
                        key,
                        physical_key: Some(key),
                        pressed,
                        repeat: false,
                        modifiers: egui::Modifiers::NONE,
                    });
                }
                if pressed && !text.is_empty() {
                    self.event(egui::Event::Text(text.to_owned()));
                }
                let mut input = self.app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
                match pressed {
                    true => input.press(key),
                    false => input.release(key),
                }
                self.app.update();
                let mut input = self.app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
                input.clear();
            }
            // A list is drawn in the frame after the one in which it opens.
            self.app.update();
            std::mem::take(&mut self.app.world_mut().resource_mut::<Struck>().0)
        }

        fn form(&self) -> &Form {
            self.app.world().resource()
        }

        fn focus(&self) -> KeyboardFocus {
            *self.app.world().resource()
        }
    }

    #[test]
    fn keys_keep_their_actions_after_tab() {
        let mut keyboard = Keyboard::new();
        assert_eq!(keyboard.strike(Tab, ""), [Action::NextObject]);
        assert!(!keyboard.has_egui());
        keyboard.event(egui::Event::Key {
            key: egui::Key::Tab,
            physical_key: Some(egui::Key::Tab),
            pressed: true,
            repeat: false,
            modifiers: egui::Modifiers::CTRL,
        });
        keyboard.app.update();
        assert!(keyboard.has_egui());
        assert_eq!(keyboard.strike(Space, " "), [Action::Pause]);
        assert_eq!(keyboard.strike(KeyR, "r"), [Action::ShowRobot]);
        assert_eq!(keyboard.strike(Escape, ""), [Action::Quit]);
    }

    #[test]
    fn space_does_not_click_the_button_that_has_the_focus_but_enter_does() {
        let mut keyboard = Keyboard::with_focus_on(Widget::Button);
        assert_eq!(keyboard.strike(Space, " "), [Action::Pause]);
        assert_eq!(keyboard.form().clicks, 0);
        assert_eq!(keyboard.strike(Enter, ""), []);
        assert_eq!(keyboard.form().clicks, 1);
    }

    #[test]
    fn arrows_do_not_move_the_slider_that_has_the_focus() {
        let mut keyboard = Keyboard::with_focus_on(Widget::Slider);
        assert_eq!(keyboard.strike(ArrowRight, ""), [Action::LookRight]);
        assert_eq!(keyboard.form().slider, 0.0);
        assert_eq!(keyboard.strike(Space, " "), [Action::Pause]);
    }

    #[test]
    fn an_open_list_takes_all_keys() {
        let mut keyboard = Keyboard::with_focus_on(Widget::List);
        assert_eq!(keyboard.strike(Enter, ""), []);
        assert!(keyboard.form().is_list_open);
        assert_eq!(keyboard.focus(), KeyboardFocus::Overlay);
        assert_eq!(keyboard.strike(KeyR, "r"), []);
        assert!(keyboard.form().is_list_open);
        assert_eq!(keyboard.strike(Escape, ""), []);
        assert!(!keyboard.form().is_list_open);
        assert_eq!(keyboard.strike(Escape, ""), [Action::Quit]);
    }

    #[test]
    fn keys_write_into_a_field_until_escape_leaves_it() {
        let mut keyboard = Keyboard::with_focus_on(Widget::Text);
        assert_eq!(keyboard.focus(), KeyboardFocus::Text);
        for (key, text) in [(KeyR, "r"), (Space, " "), (Digit2, "2")] {
            assert_eq!(keyboard.strike(key, text), []);
        }
        assert_eq!(keyboard.form().text, "r 2");
        assert_eq!(keyboard.strike(F1, ""), [Action::ShowHelp]);
        assert_eq!(keyboard.strike(Escape, ""), []);
        assert_eq!(keyboard.focus(), KeyboardFocus::World);
        assert_eq!(keyboard.strike(Space, " "), [Action::Pause]);
        assert_eq!(keyboard.form().text, "r 2");
        assert_eq!(keyboard.strike(Escape, ""), [Action::Quit]);
    }

    #[test]
    fn digits_write_a_number_until_enter_ends_it() {
        let mut keyboard = Keyboard::with_focus_on(Widget::Number);
        assert_eq!(keyboard.strike(Digit1, "1"), []);
        assert_eq!(keyboard.strike(Digit2, "2"), []);
        assert_eq!(keyboard.strike(Enter, ""), []);
        assert_eq!(keyboard.form().number, 12);
        assert_eq!(keyboard.strike(Digit1, "1"), [Action::ShowHeadView]);
        assert_eq!(keyboard.form().number, 12);
    }

    #[test]
    fn a_field_that_is_clicked_away_gives_the_keys_back() {
        let mut keyboard = Keyboard::with_focus_on(Widget::Text);
        let pos = egui::pos2(900.0, 900.0);
        keyboard.event(egui::Event::PointerMoved(pos));
        for pressed in [true, false] {
            keyboard.event(egui::Event::PointerButton {
                pos,
                button: egui::PointerButton::Primary,
                pressed,
                modifiers: egui::Modifiers::NONE,
            });
            keyboard.app.update();
        }
        assert_eq!(keyboard.strike(KeyR, "r"), [Action::ShowRobot]);
        assert_eq!(keyboard.form().text, "");
    }
}
