"""The fault injector: what may go wrong around the suite, played against a running one and measured.

fault             what a fault is: what is done, what is promised, and the checks that come of it
*_faults          the faults, grouped by what they touch; catalogue lists them all
facts             what the running nodes say of themselves: robot, limits, timeouts
probe             hears everything the suite says, with the time of receipt
cable             joint_states on their way through the injector, where they can be altered
suite_processes   the nodes as processes of one's own, to stall, kill and restart
stage             all of these, as a fault sees them
invariants        what is promised in every case
rig               plays faults one after the other and has the arm recover in between
report            the outcome for people; docs/faults.md
inject            the program
"""
