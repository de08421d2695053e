//! Scopes: the values of variables in an instance.

use std::{borrow::Cow, cell::RefCell, collections::BTreeMap, rc::Rc};

use crate::{
    expansion::{
        effort::{ExpansionBudget, MAX_TEXT},
        expression::{ExpressionError, Value, substitute, value_of},
        variable::{Variable, Variables},
    },
    fault::{Faults, Place},
    origin::InstanceId,
};

/// Largest number of variables that need each other in a row.
const MAX_NEEDS: usize = 100;

/// The variables that an element can name. Those of an instance hide those of the instances around it: first its arguments, then its
/// definition's defaults, which can need each other in any order.
pub(crate) struct Scope<'s, 'a> {
    enclosing: Option<&'s Scope<'s, 'a>>,
    /// The instance; absent for the file itself.
    pub instance: Option<InstanceId>,
    /// Arguments whose expressions use the instance's own variables.
    derived: Variables<'a>,
    defaults: Option<&'s Variables<'a>>,
    values: RefCell<BTreeMap<String, VariableProgress>>,
}

#[derive(Clone)]
enum VariableProgress {
    Begun,
    Done(Value),
}

/// The context of an evaluation: the faults, and the remaining budget.
pub(crate) struct Context<'f> {
    pub faults: &'f mut Faults,
    effort: ExpansionBudget,
    is_exhausted: bool,
    needs: usize,
}

impl<'f> Context<'f> {
    pub fn new(faults: &'f mut Faults) -> Self {
        Self {
            faults,
            effort: ExpansionBudget::default(),
            is_exhausted: false,
            needs: 0,
        }
    }

    /// True if a limit was exceeded, so that nothing more is inserted.
    pub fn is_exhausted(&self) -> bool {
        self.is_exhausted
    }

    /// Accounts for an element; a fault says once that there are too many.
    pub fn accept_element(&mut self, place: Place) -> bool {
        let is_left = self.effort.is_left_for_element();
        if !is_left {
            let most = crate::document::build::MAX_ELEMENTS;
            let problem = "after expansion there are too many elements; the rest is left out";
            self.exhaust(place, problem, &format!("at most {most} elements"));
        }
        is_left
    }

    fn accept_text(&mut self, place: Place, bytes: usize) -> bool {
        let is_left = self.effort.is_left_for_text(bytes);
        if !is_left {
            let problem = "after expansion there is too much text; the rest is left out";
            self.exhaust(
                place,
                problem,
                &format!("at most {MAX_TEXT} bytes in attributes"),
            );
        }
        is_left
    }

    fn exhaust(&mut self, place: Place, problem: &str, expected: &str) {
        if !self.is_exhausted {
            self.faults.report(place, problem, expected);
        }
        self.is_exhausted = true;
    }
}

impl<'s, 'a> Scope<'s, 'a> {
    /// The scope of the file itself, which has no variables.
    pub fn of_file() -> Self {
        Self {
            enclosing: None,
            instance: None,
            derived: Variables::new(),
            defaults: None,
            values: RefCell::default(),
        }
    }

    /// The scope of an instance with these arguments, written in the scope `enclosing`.
    pub fn of_instance(
        enclosing: &'s Scope<'s, 'a>,
        instance: InstanceId,
        arguments: Variables<'a>,
        defaults: &'s Variables<'a>,
        context: &mut Context,
    ) -> Self {
        let (derived, given): (Variables, Variables) = arguments
            .into_iter()
            .partition(|(_, argument)| argument.is_derived);
        let mut values = BTreeMap::new();
        for (name, argument) in given {
            let place = argument.place(None);
            let text = enclosing.substitute(&argument.text, place, context);
            values.insert(name, VariableProgress::Done(as_value(text)));
        }
        Self {
            enclosing: Some(enclosing),
            instance: Some(instance),
            derived,
            defaults: Some(defaults),
            values: values.into(),
        }
    }

    /// A text with its expressions replaced; `None` if that is impossible, and a fault has the reason.
    pub fn substitute(
        &self,
        text: &Cow<'a, str>,
        place: Place,
        context: &mut Context,
    ) -> Option<Cow<'a, str>> {
        self.substitute_for(None, text, place, context)
    }

    /// The same for the text of this scope's own variable. Its own name then means the variable of the surrounding scope.
    fn substitute_for(
        &self,
        own: Option<&str>,
        text: &Cow<'a, str>,
        place: Place,
        context: &mut Context,
    ) -> Option<Cow<'a, str>> {
        if !context.accept_text(place, text.len()) {
            return None;
        }
        let substituted = substitute(text, |expression| {
            value_of(expression, |name| match own == Some(name) {
                true => self.enclosing?.value(name, context),
                false => self.value(name, context),
            })
        });
        match substituted {
            Ok(substituted) => {
                let written = match &substituted {
                    Cow::Borrowed(_) => 0,
                    Cow::Owned(written) => written.len(),
                };
                context.accept_text(place, written).then_some(substituted)
            }
            Err(ExpressionError::Faulty) => None,
            Err(ExpressionError::Wrong { problem, expected }) => {
                context.faults.report(place, problem, expected);
                None
            }
        }
    }

    /// The value of a variable; `None` if there is no variable of this name.
    fn value(&self, name: &str, context: &mut Context) -> Option<Value> {
        let progress = self.values.borrow().get(name).cloned();
        let variable = || {
            let default = || self.defaults?.get(name);
            self.derived.get(name).or_else(default)
        };
        match progress {
            Some(VariableProgress::Done(value)) => Some(value),
            Some(VariableProgress::Begun) => {
                let place = variable()?.place(self.instance);
                let expected = "variables that do not need each other";
                context
                    .faults
                    .report(place, "its value needs itself", expected);
                Some(Value::Faulty)
            }
            None => match variable() {
                Some(variable) => Some(self.evaluate(name, variable, context)),
                None => self.enclosing?.value(name, context),
            },
        }
    }

    fn evaluate(&self, name: &str, variable: &Variable<'a>, context: &mut Context) -> Value {
        let note = |progress| self.values.borrow_mut().insert(name.to_owned(), progress);
        note(VariableProgress::Begun);
        let place = variable.place(self.instance);
        context.needs += 1;
        let value = if context.needs > MAX_NEEDS {
            let problem = "it needs too many variables in a row";
            let expected = format_args!("at most {MAX_NEEDS}");
            context.faults.report(place, problem, expected);
            Value::Faulty
        } else {
            as_value(self.substitute_for(Some(name), &variable.text, place, context))
        };
        context.needs -= 1;
        note(VariableProgress::Done(value.clone()));
        value
    }
}

fn as_value(text: Option<Cow<str>>) -> Value {
    match text {
        Some(text) => Value::Text(Rc::from(text)),
        None => Value::Faulty,
    }
}
