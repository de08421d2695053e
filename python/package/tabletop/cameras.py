"""Lists of cameras, as `tabletop export --cameras` has them: `head,left_hand,side=12,-4,7,0,0,1`."""


def camera_list(text: str) -> list[str]:
    """The cameras of a list."""
    cameras: list[str] = []
    for word in text.split(","):
        if cameras and _is_number(word):
            cameras[-1] += f",{word}"
        else:
            cameras.append(word.strip())
    return cameras


def camera_name(camera: str) -> str:
    """The name of a camera."""
    return camera.split("=")[0]


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
