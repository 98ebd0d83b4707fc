"""glTF: surfaces for viewers and game engines."""

from .writing import MeshArrays, choose_colors, encode_glb, turn_up

__all__ = ["MeshArrays", "choose_colors", "encode_glb", "turn_up"]
