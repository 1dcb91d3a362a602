"""What the panel says of each scene. Not stored in files: it is found anew with every update.

Where nobody sees the panel, which is in the background and while frames change, the console has it as well.
"""

import sys

import bpy

_errors: dict[int, str] = {}
_notes: dict[int, list[str]] = {}
_said: dict[int, set[str]] = {}


def succeed(scene, notes: list[str], faults: list[str], frame: int | None) -> None:
    """faults: what else is amiss, though the sky is by the settings; frame: if that is what changed."""
    _errors.pop(scene.session_uid, None)
    _notes[scene.session_uid] = notes + faults
    _say(scene, faults, frame)


def fail(scene, message: str, frame: int | None) -> None:
    _errors[scene.session_uid] = message
    _say(scene, [message], frame, "; the sky is still the one before")


def _say(scene, messages: list[str], frame: int | None, end: str = "") -> None:
    """A line for each message that was not there at the update before."""
    before = _said.get(scene.session_uid, set())
    if bpy.app.background or frame is not None:
        at = scene.frame_current if frame is None else frame
        for message in messages:
            if message not in before:
                print(f"welkin: {scene.name}, frame {at}: {message}{end}", file=sys.stderr, flush=True)
    _said[scene.session_uid] = set(messages)


def error(scene) -> str | None:
    """Why the sky is still the former one."""
    return _errors.get(scene.session_uid)


def notes(scene) -> list[str]:
    return _notes.get(scene.session_uid, [])


def clear() -> None:
    _errors.clear()
    _notes.clear()
    _said.clear()
