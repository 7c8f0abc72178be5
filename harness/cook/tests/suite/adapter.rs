//! A missing adapter is an error, never another adapter and never a pass.

use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_testing::gpu;
use lapidary_testing::program::{cook, cook_in};

#[test]
fn an_unknown_adapter_is_named_with_what_there_is() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let answer = cook(folder.path(), &["check", "refraction", "--adapter", "nonsense"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert_eq!(answer.stdout, "");
    assert_eq!(answer.stderr.trim_end().lines().count(), 1, "{answer:?}");
    assert!(answer.stderr.starts_with("cook: no adapter matches `nonsense`; this system offers `"), "{answer:?}");
    assert!(answer.stderr.contains(&gpu().info.name), "{answer:?}");
    assert!(answer.stderr.contains("Choose one of them with LAPIDARY_ADAPTER"), "{answer:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_system_without_adapters_is_told_what_to_install() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let none = [
        ("VK_DRIVER_FILES", "/nonexistent.json"),
        ("VK_ICD_FILENAMES", "/nonexistent.json"),
        (lapidary_gpu::ADAPTER_VARIABLE, "lavapipe"),
    ];
    for command in ["check", "render"] {
        let subject = if command == "check" { "refraction" } else { "octahedron" };
        let answer = cook_in(folder.path(), &[command, subject], &none);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert_eq!(answer.stdout, "");
        assert!(answer.stderr.contains("no adapter matches `lavapipe`"), "{answer:?}");
        assert!(answer.stderr.contains("offers none") && answer.stderr.contains("mesa-vulkan-drivers"), "{answer:?}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn an_empty_name_chooses_nothing() {
    // `--adapter "$GPU"` with an unset variable gives an empty name, which is a part of every
    // adapter's name.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let answer = cook(folder.path(), &["check", "refraction::reflect", "--cases", "1", "--adapter", ""]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
}

#[test]
fn a_process_with_a_device_does_not_pretend_to_be_on_another() {
    let open = gpu();
    let error = Gpu::shared(&AdapterChoice::Named("no such GPU".to_owned())).expect_err("no such adapter");
    let message = error.to_string();
    assert!(message.contains(&open.info.name) && message.contains("`no such GPU`"), "{message}");
    // The same device under another name is not a second device.
    let again = Gpu::shared(&AdapterChoice::Named(open.info.name.to_uppercase())).expect("the device that is open");
    assert!(std::ptr::eq(open, again));
}
