"""What may be carried from frame to frame, as options of `lightwalk animate`."""
import sys

#: What is kept and how it is looked up: ours, and as the paper did it.
WAYS = {"supersaturated": "--reuse supersaturated", "cloud": "--reuse cloud",
        "paper": "--reuse supersaturated --look forward --check edges",
        "paper's first": "--reuse cloud --look forward --check edges"}

#: Each rule by itself: its settings, the weakest first, and what else has to be so for it to count. The watch over
#: the errors (--audit-limit) is off but where it is what is measured: it would make good what a rule lets through.
RULES = {"check": (("none", "edges", "rotating", "all"), ""),
         "drop": (("none", "hidden", "lonely", "both"), "--check none"),
         "look": (("forward", "back"), ""),
         "near": (("1.5", "1.25", "1", ".7", ".35", "0"), ""),
         "reach": (("1.5", "1", "0"), ""),
         "contrast": (("100", "10", "0"), ""),
         "specular-tolerance": (("100", "20", "10", "5"), ""),
         "audit-limit": (("0", "10", "5"), "")}


def rules(names):
    """{label: options} of the rules of these names, separated by commas, or of "all": for each rule all its settings.
    Before them the defaults, and a picture traced with other random numbers: as far as that is off is no fault."""
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
    """{label: options} of texts "LABEL=OPTIONS"."""
    for text in texts:
        if "=" not in text:
            sys.exit(f"--reuse: expected LABEL=OPTIONS, found {text}")
    return dict(text.split("=", 1) for text in texts)
