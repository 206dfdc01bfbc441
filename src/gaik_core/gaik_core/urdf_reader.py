"""Reading a URDF: its text by `urdf_parser_py`, its links and joints as a tree that has been checked."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from urdf_parser_py.urdf import URDF
from urdf_parser_py.xml_reflection.core import ParseError
from urdf_parser_py.xml_reflection.core import Path as ElementPath

from gaik_core.errors import UrdfError

KINEMATIC = {
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "parent": ("link",),
    "child": ("link",),
    "limit": ("lower", "upper"),
    "mimic": ("joint", "multiplier", "offset"),
}
"""What of a joint bears on kinematics. The rest (meshes, inertias, transmissions, …) never reaches the reader, which
prints a line for each tag it does not know and gives up on some that no kinematics needs."""

REQUIRED = {"axis": "xyz", "parent": "link", "child": "link", "mimic": "joint"}

LISTED = 20
"""More names than this are not listed in a message."""


class UrdfTree:
    """Links and joints of a URDF: one root, and one joint above every other link.

    Attributes:
        source: the file, or "URDF" for a text; error messages begin with it.
        name: of the robot.
        joints: the joints by name, as urdf_parser_py has them.
        links: the names of the links, as they stand in the file.
        root: the link that has no parent.
    """

    def __init__(self, text_or_path: str | Path) -> None:
        """Read a text, or the file at a path.

        Raises:
            UrdfError: what is wrong, in one line.
        """
        self.source, content = _content(text_or_path)
        robot = _parse(self.source, content)
        self.name: str = robot.name
        self.links: list[str] = [link.name for link in robot.links]
        self.joints: dict[str, Any] = {joint.name: joint for joint in robot.joints}
        self._refuse_twins("link", self.links)
        self._refuse_twins("joint", [joint.name for joint in robot.joints])
        self._above = self._joints_above()
        self.root = self._only_root()

    def error(self, message: str) -> UrdfError:
        """An error that names the source."""
        return UrdfError(f"{self.source}: {message}")

    def check_link(self, what: str, link: str) -> None:
        """Raise UrdfError where there is no such link."""
        if not isinstance(link, str):
            raise self.error(f"{what} is {link!r}; expected the name of a link")
        if link not in self.links:
            raise self.error(f"{what}: no link {link!r}{_hint(link, self.links)}")

    def leaves(self, base: str) -> list[str]:
        """The links at or below `base` that have no children."""
        self.check_link("base", base)
        parents = {joint.parent for joint in self.joints.values()}
        return [
            link
            for link in self.links
            if link not in parents and base in {link, *(joint.parent for joint in self._upward(link))}
        ]

    def path(self, base: str, tip: str) -> list[Any]:
        """The joints from one link down to another; raises UrdfError where there is no such way."""
        self.check_link("base", base)
        self.check_link("tip", tip)
        joints = []
        for joint in self._upward(tip):
            joints.append(joint)
            if joint.parent == base:
                return joints[::-1]
        if base == tip:
            raise self.error(f"base and tip are the same link {base!r}")
        turned = any(joint.parent == tip for joint in self._upward(base))
        raise self.error(
            f"tip {tip!r} is not below base {base!r}" + (", but above it: exchange them" if turned else "")
        )

    def _upward(self, link: str) -> Iterable[Any]:
        """The joints from a link up to the root."""
        while link in self._above:
            yield self._above[link]
            link = self._above[link].parent

    def _refuse_twins(self, what: str, names: list[str]) -> None:
        for name in names:
            if names.count(name) > 1:
                raise self.error(f"two {what}s are called {name!r}; names must differ")

    def _joints_above(self) -> dict[str, Any]:
        above: dict[str, Any] = {}
        for joint in self.joints.values():
            self.check_link(f"joint {joint.name!r}: parent", joint.parent)
            self.check_link(f"joint {joint.name!r}: child", joint.child)
            if joint.child in above:
                both = f"{above[joint.child].name!r} and {joint.name!r}"
                raise self.error(f"link {joint.child!r} is the child of two joints, {both}: not a tree")
            above[joint.child] = joint
        return above

    def _only_root(self) -> str:
        """The link all others hang from: a link that is met twice on the way up lies on a circle."""
        if not self.links:
            raise self.error("has no link")
        for link in self.links:
            seen = {link}
            for joint in self._upward(link):
                if joint.parent in seen:
                    raise self.error(f"the links form a circle through {joint.parent!r}; a URDF is a tree")
                seen.add(joint.parent)
        roots = [link for link in self.links if link not in self._above]
        if len(roots) > 1:
            raise self.error(f"disconnected: the links {listed(roots)} have no parent; only one may")
        return roots[0]


def listed(names: list[str]) -> str:
    """Names with commas between them, the first few where there are many."""
    more = f", … ({len(names)} in all)" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more


def _hint(name: str, known: list[str]) -> str:
    near = get_close_matches(name, known, n=3)
    return f" (did you mean {' or '.join(map(repr, near))}?)" if near else f"; links: {listed(known)}"


def _content(text_or_path: str | Path) -> tuple[str, str | bytes]:
    """Where a text comes from, and the text."""
    if isinstance(text_or_path, str) and "<" in text_or_path:
        return "URDF", text_or_path
    if not isinstance(text_or_path, str | Path):
        raise UrdfError(f"URDF is a {type(text_or_path).__name__}; expected its text or the path of a file")
    try:
        return str(text_or_path), Path(text_or_path).read_bytes()
    except (OSError, ValueError) as error:
        what = getattr(error, "strerror", None) or error
        raise UrdfError(f"{str(text_or_path)[:200]!r} is neither a URDF text nor a file: {what}") from None


def _parse(source: str, content: str | bytes) -> Any:
    """The robot as urdf_parser_py has it, without what is not kinematics."""
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, ValueError) as error:
        if "<xacro:" in str(content):
            raise _is_xacro(source) from None
        raise UrdfError(f"{source}: not XML: {error}") from None
    if any("xacro" in str(element.tag).partition("}")[0] for element in root.iter()):
        raise _is_xacro(source)
    if root.tag != "robot":
        raise UrdfError(f"{source}: the root element is <{root.tag}>; a URDF's is <robot>")
    try:
        return URDF.from_xml(_kinematic_part(source, root), ElementPath("robot"))
    except UrdfError:
        raise
    except ParseError as error:
        raise UrdfError(f"{source}: {error.path}: {error.e}") from None
    except Exception as error:  # the reader raises bare Exception, and AssertionError, on bad input
        raise UrdfError(f"{source}: {error}") from None


def _is_xacro(source: str) -> UrdfError:
    return UrdfError(f"{source}: is xacro, not yet URDF; expand it first (xacro {source} > robot.urdf)")


def _kinematic_part(source: str, root: ElementTree.Element) -> ElementTree.Element:
    """The links' names and of each joint what `KINEMATIC` lists; of two equal tags the first, as urdfdom does."""
    robot = ElementTree.Element("robot", _kept(root, ("name", "version")))
    for link in root.findall("link"):
        robot.append(ElementTree.Element("link", _kept(link, ("name",))))
    for joint in root.findall("joint"):
        copy = ElementTree.SubElement(robot, "joint", _kept(joint, ("name", "type")))
        for tag, attributes in KINEMATIC.items():
            element = joint.find(tag)
            if element is None:
                continue
            _check_attribute(source, joint.get("name", "?"), element)
            # effort and velocity must be there for the reader, and mean nothing here
            unused = {"effort": "0", "velocity": "0"} if tag == "limit" else {}
            copy.append(ElementTree.Element(tag, unused | _kept(element, attributes)))
    return robot


def _check_attribute(source: str, joint: str, element: ElementTree.Element) -> None:
    """Refuse what the reader would stumble over without saying at which joint."""
    attribute = REQUIRED.get(element.tag)
    if attribute is not None and attribute not in element.attrib:
        raise UrdfError(f"{source}: joint {joint!r}: <{element.tag}> has no attribute {attribute!r}")
    if element.tag == "axis":
        try:
            _, _, _ = map(float, element.attrib["xyz"].split())
        except ValueError:
            raise UrdfError(
                f"{source}: joint {joint!r}: axis is {element.attrib['xyz']!r}; expected three numbers"
            ) from None


def _kept(element: ElementTree.Element, attributes: tuple[str, ...]) -> dict[str, str]:
    return {name: element.attrib[name] for name in attributes if name in element.attrib}
