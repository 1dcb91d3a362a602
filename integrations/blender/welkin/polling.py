"""What operators ask before they run."""


def is_local(operator, context) -> bool:
    """Whether the scene can be changed: that of another file cannot."""
    if context.scene.library is not None:
        operator.poll_message_set("The scene is linked from another file")
        return False
    return True
