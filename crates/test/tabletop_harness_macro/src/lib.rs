//! The attribute of `tabletop_harness`.

use proc_macro::{TokenStream, TokenTree};

/// A test that needs tools: `#[test_with(Octave, Python)]`. `#[cfg]` and the like go above it.
///
/// # Panics
/// Which ends the compilation: it does not belong to a function, or its argument is no list of prerequisites.
#[proc_macro_attribute]
pub fn test_with(prerequisites: TokenStream, test: TokenStream) -> TokenStream {
    let name = name(test.clone()).expect("test_with belongs to a function");
    let entry = format!(
        "const _: () = {{
            use ::tabletop_harness::Prerequisite::{{{prerequisites}}};
            ::tabletop_harness::inventory::submit! {{
                ::tabletop_harness::RegisteredTest {{
                    name: concat!(module_path!(), \"::{name}\"),
                    prerequisites: &[{prerequisites}],
                    run: {name},
                }}
            }}
        }};"
    );
    let entry: TokenStream = entry.parse().expect("names of prerequisites");
    test.into_iter().chain(entry).collect()
}

fn name(test: TokenStream) -> Option<TokenTree> {
    let mut tokens = test.into_iter();
    tokens.find(|token| token.to_string() == "fn")?;
    tokens.next()
}
