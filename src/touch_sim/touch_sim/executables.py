"""The twin's executable; the demo and the view read their options, and say what is missing, before they import."""

from gaik_ros.executables import executable

touch_sim = executable("touch_sim.touch_sim_node")
