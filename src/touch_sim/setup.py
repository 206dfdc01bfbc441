from pathlib import Path

from setuptools import find_packages, setup

package_name = "touch_sim"


def files(pattern: str) -> list[str]:
    return [str(path) for path in Path().glob(pattern)]


setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    # The URDF is package data too, so that it is found where there is no share folder (pip install -e).
    package_data={package_name: ["urdf/*.urdf", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package_name}"]),
        (f"share/{package_name}", ["package.xml"]),
        (f"share/{package_name}/launch", files("launch/*.launch.py")),
        *(
            (f"share/{package_name}/{tool}", files(f"{tool}/touch.*"))
            for tool in ("rviz", "plotjuggler", "foxglove")
        ),
        (f"share/{package_name}/urdf", files(f"{package_name}/urdf/*.urdf")),
        # pip puts console scripts into bin/ only; `ros2 run` looks in lib/<package>/.
        (f"lib/{package_name}", files("scripts/*")),
    ],
    install_requires=["gaik_core", "gaik_ros", "numpy>=1.26", "tqdm>=4.66"],
    extras_require={"figures": ["matplotlib>=3.6"], "test": ["pytest", "scipy"]},
    python_requires=">=3.11",
    zip_safe=True,
    maintainer="The gaik developers",
    maintainer_email="developers@gaik.dev",
    description="A twin of the Geomagic Touch, and a demo of the whole suite with it.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "touch_sim = touch_sim.executables:touch_sim",
            "demo = touch_sim.demo:main",
            "view = touch_sim.view:main",
        ],
        "gaik.experiments": [
            "fig21 = touch_sim.experiments:FIG21",
            "fig22 = touch_sim.experiments:FIG22",
        ],
        "gaik.suites": ["twin = touch_sim.suite:twin_nodes"],
    },
)
