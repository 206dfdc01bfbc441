"""A twin of the Geomagic Touch haptic device, its ROS 2 node, and a demo of the whole suite with it."""
