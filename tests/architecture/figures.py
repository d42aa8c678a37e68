"""The size and shape of the tree in figures: `python -m tests.architecture.figures [ROOT]` prints them as a table."""

import sys
from pathlib import Path
from statistics import median

from tests.architecture.rules import Tree, arguments, circles, folder_sizes, lines
from tests.architecture.sources import PACKAGES, ROOT, functions, is_kernel, sources


def figures(root: Path = ROOT) -> dict[str, str]:
    """Name and value of each figure of the checkout at ``root``."""
    tree = Tree.at(root)
    kernels = [node for source in tree.modules for node in functions(source.tree, inside_kernels=True)]
    kernels = [node for node in kernels if is_kernel(node)]
    counts = sorted(map(arguments, kernels))
    longest = max(kernels, key=lines)
    folder, most = folder_sizes(tree).most_common(1)[0]
    tests = sources(root, ("tests",))
    rings = circles(tree)

    def length(modules: list) -> int:
        return sum(len(source.text.splitlines()) for source in modules)

    readme = (root / "README.md").read_bytes()
    return {
        "files of the packages": str(len(tree.modules)),
        "lines of the packages": str(length(tree.modules)),
        "lines of the tests": str(length(tests)),
        "files in the largest folder": f"{most} ({folder})",
        "longest file, lines": str(max(len(source.text.splitlines()) for source in tree.modules)),
        "import circles (files in them)": f"{len(rings)} ({sum(map(len, rings))})",
        "kernels": str(len(kernels)),
        "arguments of a kernel, median / 95 % / most": (
            f"{median(counts):g} / {counts[int(0.95 * len(counts))]} / {counts[-1]}"
        ),
        "kernels above 12 arguments": str(sum(count > 12 for count in counts)),
        "longest kernel, lines": f"{lines(longest)} ({longest.name})",
        "README, bytes / lines": f"{len(readme)} / {len(readme.splitlines())}",
        "packages": ", ".join(PACKAGES),
    }


if __name__ == "__main__":
    for name, value in figures(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT).items():
        print(f"| {name} | {value} |")
