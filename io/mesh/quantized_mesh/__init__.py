"""Quantized-mesh 1.0: terrain tiles for Cesium and other globes."""
