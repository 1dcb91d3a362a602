"""Aerial perspective as a node group of the compositor.

The light of things, which is the picture without its environment pass, is multiplied by what the air lets through;
what the air scatters to the camera is added. Both are looked up by place in the picture and depth, between two slices.
"""

import bpy

from .core.air import COLUMNS, ROWS, SLICES

GROUP = "Welkin Air"
REACH = "Reach"
NOTHING = 1e9
"""Depths beyond are those of the sky, which has its air already."""


class _Builder:
    """Adds nodes to a tree and links what they take."""

    def __init__(self, tree):
        self.tree = tree
        self.column = 0

    def node(self, kind: str, **attributes):
        node = self.tree.nodes.new(kind)
        node.location = (170.0 * self.column, 0.0)
        self.column += 1
        for name, value in attributes.items():
            setattr(node, name, value)
        return node

    def feed(self, socket, source) -> None:
        if isinstance(source, bpy.types.NodeSocket):
            self.tree.links.new(source, socket)
        else:
            socket.default_value = source

    def math(self, operation: str, *sources):
        node = self.node("ShaderNodeMath", operation=operation)
        for socket, source in zip(node.inputs, sources):
            self.feed(socket, source)
        return node.outputs[0]

    def vector(self, operation: str, *sources):
        node = self.node("ShaderNodeVectorMath", operation=operation)
        for socket, source in zip(node.inputs, sources):
            self.feed(socket, source)
        return node.outputs["Vector"]

    def scale(self, vector, factor):
        node = self.node("ShaderNodeVectorMath", operation="SCALE")
        self.feed(node.inputs[0], vector)
        self.feed(node.inputs["Scale"], factor)
        return node.outputs["Vector"]

    def look_up(self, image, place):
        picture = self.node("CompositorNodeImage")
        picture.image = image
        node = self.node("CompositorNodeMapUV")
        self.feed(node.inputs["Image"], picture.outputs["Image"])
        self.feed(node.inputs["UV"], place)
        node.inputs["Interpolation"].default_value = "Bilinear"
        for side in ("Extension X", "Extension Y"):
            node.inputs[side].default_value = "Extend"
        return node.outputs["Image"]


def build_group(light: bpy.types.Image, factors: bpy.types.Image) -> bpy.types.NodeTree:
    tree = bpy.data.node_groups.new(GROUP, "CompositorNodeTree")
    for name, kind in (
        ("Image", "NodeSocketColor"),
        ("Alpha", "NodeSocketFloat"),
        ("Depth", "NodeSocketFloat"),
        ("Environment", "NodeSocketColor"),
        (REACH, "NodeSocketFloat"),
    ):
        tree.interface.new_socket(name, in_out="INPUT", socket_type=kind)
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    build = _Builder(tree)
    given = build.node("NodeGroupInput").outputs
    first, second, share = _places(build, given)
    taken = _between(build, factors, first, second, share)
    added = _between(build, light, first, second, share)
    things = build.vector("SUBTRACT", given["Image"], given["Environment"])
    seen = build.vector("MULTIPLY", things, taken)
    there = build.math("MULTIPLY", build.math("LESS_THAN", given["Depth"], NOTHING), given["Alpha"])
    total = build.vector("ADD", build.vector("ADD", seen, given["Environment"]), build.scale(added, there))
    alpha = build.node("CompositorNodeSetAlpha")
    alpha.inputs["Type"].default_value = "Replace Alpha"
    build.feed(alpha.inputs["Image"], total)
    build.feed(alpha.inputs["Alpha"], given["Alpha"])
    build.feed(build.node("NodeGroupOutput").inputs["Image"], alpha.outputs["Image"])
    return tree


def _places(build, given):
    """Where in the pictures of the volume the two slices are, and the share of the second."""
    coordinates = build.node("CompositorNodeImageCoordinates")
    build.feed(coordinates.inputs["Image"], given["Image"])
    split = build.node("ShaderNodeSeparateXYZ")
    build.feed(split.inputs[0], coordinates.outputs["Normalized"])
    x, y = split.outputs["X"], split.outputs["Y"]
    depth = build.math("MINIMUM", build.math("DIVIDE", given["Depth"], given[REACH]), 1.0)
    slice_ = build.math("MULTIPLY", build.math("SQRT", depth), SLICES - 1.0)
    first = build.math("MINIMUM", build.math("FLOOR", slice_), SLICES - 2.0)
    share = build.math("SUBTRACT", slice_, first)
    # The edges of the picture are at the centres of the outermost pixels of the volume.
    u = build.math("DIVIDE", build.math("MULTIPLY_ADD", x, COLUMNS - 1.0, 0.5), float(COLUMNS))
    row = build.math("MULTIPLY_ADD", y, ROWS - 1.0, 0.5)
    v = build.math("DIVIDE", build.math("MULTIPLY_ADD", first, float(ROWS), row), float(ROWS * SLICES))
    return _place(build, u, v), _place(build, u, build.math("ADD", v, 1.0 / SLICES)), share


def _place(build, u, v):
    node = build.node("ShaderNodeCombineXYZ")
    for socket, source in zip(node.inputs, (u, v, 1.0)):
        build.feed(socket, source)
    return node.outputs[0]


def _between(build, image, first, second, share):
    low, high = build.look_up(image, first), build.look_up(image, second)
    return build.vector("ADD", low, build.scale(build.vector("SUBTRACT", high, low), share))


def tree_of(scene):
    return getattr(scene, "compositing_node_group", None)


def group_node(scene):
    tree = tree_of(scene)
    return tree.nodes.get(GROUP) if tree else None


def set_reach(scene, reach: float) -> None:
    """In Blender units, as depths are."""
    node = group_node(scene)
    if node is not None and abs(node.inputs[REACH].default_value - reach) > 1e-6 * reach:
        node.inputs[REACH].default_value = reach


def insert(scene, light: bpy.types.Image, factors: bpy.types.Image) -> None:
    """Puts the group right behind the render layers, before whatever else the compositor does."""
    tree = tree_of(scene) or _new_tree(scene)
    layers = next((node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers"), None)
    if layers is None:
        layers = tree.nodes.new("CompositorNodeRLayers")
    node = tree.nodes.new("CompositorNodeGroup")
    node.node_tree = build_group(light, factors)
    node.name = node.label = GROUP
    node.location = (layers.location.x + 300.0, layers.location.y)
    for target in [link.to_socket for link in tree.links if link.from_socket == layers.outputs["Image"]]:
        tree.links.new(node.outputs["Image"], target)
    for name in ("Image", "Alpha", "Depth", "Environment"):
        tree.links.new(layers.outputs[name], node.inputs[name])
    output = next((node for node in tree.nodes if node.bl_idname == "NodeGroupOutput"), None)
    if output is not None and not output.inputs["Image"].is_linked:
        tree.links.new(node.outputs["Image"], output.inputs["Image"])


def _new_tree(scene):
    tree = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    tree.nodes.new("NodeGroupOutput").location = (700.0, 0.0)
    scene.compositing_node_group = tree
    return tree


def take_out(scene) -> None:
    """Links what came from the group to where its picture came from."""
    node = group_node(scene)
    if node is None:
        return
    tree, group = tree_of(scene), node.node_tree
    sources = [link.from_socket for link in node.inputs["Image"].links]
    for target in [link.to_socket for link in node.outputs["Image"].links]:
        for source in sources:
            tree.links.new(source, target)
    tree.nodes.remove(node)
    if group is not None and not group.users:
        bpy.data.node_groups.remove(group)
