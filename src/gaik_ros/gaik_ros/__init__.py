"""The ROS 2 side of gaik: nodes for inverse kinematics and joint control, and what every node shares."""
