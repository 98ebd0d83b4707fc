"""3D Tiles 1.1: surfaces at several scales for globes."""

from .tileset import Content, Scene, encode_content, format_tileset

__all__ = ["Content", "Scene", "encode_content", "format_tileset"]
