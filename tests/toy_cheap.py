"""A study as cheap to import as a real one should be."""

from mjmr.conditions import Grid, Parameter
from mjmr.study import Size, Study

study = Study(
    name="cheap",
    title="Nothing heavy",
    paper="none",
    summary="Imports the declaration only.",
    parameters=(Parameter("bias", "Probability", 0.5),),
    sizes=(Size("quick", (Grid(),), 1, 0.1),),
    trial="tests.toy_study:trial",
)
