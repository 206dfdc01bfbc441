"""Every process of tests has its own ROS domain, hears only this host, and has rclpy's field checks on."""

import os

worker = os.environ.get("PYTEST_XDIST_WORKER")  # gw0, gw1, …: neighbours of one run, which must not meet
number = os.getppid() + int(worker[2:]) if worker else os.getpid()
os.environ["ROS_DOMAIN_ID"] = str(1 + number % 100)
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"
