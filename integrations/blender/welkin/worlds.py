"""The world of the sky: an environment texture, a background and what links them."""

import bpy

ENVIRONMENT, BACKGROUND = "Welkin Sky", "Welkin Background"


def build(world: bpy.types.World) -> None:
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    environment = tree.nodes.new("ShaderNodeTexEnvironment")
    background = tree.nodes.new("ShaderNodeBackground")
    environment.name = environment.label = ENVIRONMENT
    background.name = background.label = BACKGROUND
    environment.projection, environment.interpolation = "EQUIRECTANGULAR", "Linear"
    environment.location, background.location = (-300, 0), (0, 0)
    link(world)


def link(world) -> None:
    """From the environment to the background and the output; other nodes stay."""
    tree = world.node_tree
    environment, background = environment_of(world), background_of(world)
    output = tree.get_output_node("ALL")
    if output is None:
        output = tree.nodes.new("ShaderNodeOutputWorld")
        output.location = (200, 0)
    if environment not in _before(tree, background):
        tree.links.new(environment.outputs["Color"], background.inputs["Color"])
    if background not in _before(tree, output):
        tree.links.new(background.outputs["Background"], output.inputs["Surface"])


def is_whole(world) -> bool:
    """Whether it has both nodes."""
    return environment_of(world) is not None and background_of(world) is not None


def is_linked(world) -> bool:
    """Whether what the environment has reaches the output, by nodes of the user's or not."""
    tree = world.node_tree
    output, background = tree.get_output_node("ALL"), background_of(world)
    return background in _before(tree, output) and environment_of(world) in _before(tree, background)


def _before(tree, node) -> list:
    """Nodes on which a node depends."""
    found, ahead = [], [node]
    while ahead:
        target = ahead.pop()
        for one in tree.links:
            if one.to_node == target and not one.is_muted and one.from_node not in found:
                found.append(one.from_node)
                ahead.append(one.from_node)
    return found


def environment_of(world):
    return _node(world, ENVIRONMENT)


def background_of(world):
    return _node(world, BACKGROUND)


def _node(world, name: str):
    tree = world.node_tree if world else None
    return tree.nodes.get(name) if tree else None


def change(scene, world) -> None:
    """The scene gets a world of the sky. Its first other one is the former world; none is lost."""
    replaced, scene.world = scene.world, world
    if replaced is None or _is_of_a_sky(replaced):
        return
    if scene.welkin.former_world is None:
        scene.welkin.former_world = replaced
    keep(replaced)


def keep(world) -> None:
    """Blender does not save what nothing uses."""
    if not world.users:
        world.use_fake_user = True


def _is_of_a_sky(world) -> bool:
    return environment_of(world) is not None or any(other.welkin.world == world for other in bpy.data.scenes)
