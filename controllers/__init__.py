"""The algorithms: numpy in, numpy out; they know no MuJoCo and no study."""
