"""Walking machines: legs' kinematics, numpy in and numpy out."""
