//! What users rely on in text: every signature and every promised accuracy. A change of either is a change of the cookbook's
//! interface, and is to be seen in review. `INSTA_UPDATE=always ./cook test text` accepts it.

use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::cookbook;
use std::fmt::Write as _;

#[test]
fn signatures_and_accuracies_are_as_they_were() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../../../snapshots/cookbook");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for module in cookbook::modules() {
            let (ir, _) = dispatch::parse(module.source, module.name).expect("the cookbook's WGSL is valid");
            let mut text = String::new();
            for function in &module.functions {
                let signature = Signature::reflect(&ir, &function.name).expect("a function of the module");
                let _ = writeln!(text, "{signature}\n    {}", function.accuracy);
            }
            insta::assert_snapshot!(module.name, text);
        }
    });
}
