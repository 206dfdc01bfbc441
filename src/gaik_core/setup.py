from glob import glob

from setuptools import find_packages, setup

package_name = "gaik_core"

setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={package_name: ["robots/*.yaml", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package_name}"]),
        (f"share/{package_name}", ["package.xml"]),
        (f"lib/{package_name}", glob("scripts/*")),
    ],
    # The oldest versions are Ubuntu 24.04's, which a ROS 2 Jazzy desktop has.
    install_requires=["numpy>=1.26", "numba>=0.58", "PyYAML>=6", "tqdm>=4.66", "urdf-parser-py>=0.0.4"],
    extras_require={"figures": ["matplotlib>=3.6"], "completion": ["argcomplete>=3.1"], "test": ["pytest"]},
    python_requires=">=3.11",
    zip_safe=True,
    maintainer="The gaik developers",
    maintainer_email="developers@gaik.dev",
    description="Inverse kinematics in quaternion algebra and in conformal geometric algebra.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["gaik = gaik_core.cli.main:main"],
        "gaik.commands": [
            "bench = gaik_core.cli.bench:COMMAND",
            "reproduce = gaik_core.cli.reproduce:COMMAND",
            "robots = gaik_core.cli.robots:COMMAND",
            "solve = gaik_core.cli.solve:COMMAND",
            "workspace = gaik_core.cli.workspace:COMMAND",
        ],
    },
)
