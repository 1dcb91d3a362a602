"""What the panel says of each scene. Not stored in files: it is found anew with every update."""

_errors: dict[int, str] = {}
_notes: dict[int, list[str]] = {}


def succeed(scene, notes: list[str]) -> None:
    _errors.pop(scene.session_uid, None)
    _notes[scene.session_uid] = notes


def fail(scene, message: str) -> None:
    _errors[scene.session_uid] = message


def error(scene) -> str | None:
    """Why the sky is still the former one."""
    return _errors.get(scene.session_uid)


def notes(scene) -> list[str]:
    return _notes.get(scene.session_uid, [])


def clear() -> None:
    _errors.clear()
    _notes.clear()
