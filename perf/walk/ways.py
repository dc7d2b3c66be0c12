"""Settings of reuse between frames, as options of `lightwalk animate`."""
import sys

#: Settings of points and of their reuse: ours, and those that imitate the paper.
WAYS = {"supersaturated": "--reuse supersaturated", "cloud": "--reuse cloud",
        "paper": "--reuse supersaturated --look forward --check edges",
        "paper's first": "--reuse cloud --look forward --check edges"}

#: The settings of each rule, the weakest first, and the other options under which it has an effect. The controller of
#: errors (--audit-limit) is off except where it is what is measured, as it would compensate for the errors of a rule.
RULES = {"check": (("none", "edges", "rotating", "all"), ""),
         "drop": (("none", "hidden", "lonely", "both"), "--check none"),
         "look": (("forward", "back"), ""),
         "near": (("1.5", "1.25", "1", ".7", ".35", "0"), ""),
         "reach": (("1.5", "1", "0"), ""),
         "contrast": (("100", "10", "0"), ""),
         "specular-tolerance": (("100", "20", "10", "5"), ""),
         "audit-limit": (("0", "10", "5"), "")}


def rules(names):
    """{label: options}: all settings of each rule whose name is in `names` (separated by commas, or "all"). Before them come
    the defaults, and a fully traced picture with other random numbers, whose error is the noise of any picture."""
    wanted = list(RULES) if names == "all" else names.split(",")
    unknown = [name for name in wanted if name not in RULES]
    if unknown:
        sys.exit(f"--rules: there is no rule {unknown[0]}; there are all, {', '.join(RULES)}")
    found = {"traced, other seed": "--reuse off --seed 1", "defaults": ""}
    for name in wanted:
        settings, beside = RULES[name]
        unwatched = "" if name == "audit-limit" else " --audit-limit 0"
        for setting in settings:
            found[f"{name} {setting}"] = f"{beside} --{name} {setting}{unwatched}".strip()
    return found


def given(texts):
    """{label: options}, from texts "LABEL=OPTIONS"."""
    for text in texts:
        if "=" not in text:
            sys.exit(f"--reuse: expected LABEL=OPTIONS, found {text}")
    return dict(text.split("=", 1) for text in texts)
