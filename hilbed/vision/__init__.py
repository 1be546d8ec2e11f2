"""From a camera pose to an image and from an image to azimuths."""
