"""The paper's words, letter by letter, mathematics as LaTeX; and what says it is not in it."""

ABSENT = "not in the paper: "
"""Before every text of a claim that the paper does not make."""
ONE_POINT = (
    "all particles move to the same position but with different horizontal and vertical "
    "coordinates value"
)
CHANNELS = "different horizontal and vertical coordinates value"
CONVERGES = (
    "the overall system will still converge even when the directed sensor graphs are always not "
    "strongly connected"
)
STOCHASTIC = "$P_{ss}(k)$ is row-stochastic matrix"
NONNEGATIVE = (
    "A square real matrix is row stochastic if it is non-negative and its row sums all equal 1"
)
LEMMA_21 = r"\bar{E} is irreducible if and only if E is irreducible"
LEMMA_22 = r"$\lim_{k \rightarrow \infty} \prod_{l=0}^{k-1} P(k-l) = \mathbf{1}_R c$"
LEMMA_22_WEIGHT = r"constant vector $c = [c_1, 0, \dots, 0]"
LEMMA_23 = (
    r"if and only if $\lim_{k \rightarrow \infty} \prod_{l=0}^{k-1} P(k-l) = \mathbf{1}_R c_2$"
)
HEARS = (
    r"for every $i > 1$, there is at least one j such that "
    r"$G_{T_2,ij}(t_{s_v}^G) \succ 0$, $j < i$"
)

LEADER = ABSENT + "if one robot leads for ever, it alone has weight"
SHARED = ABSENT + "if leaders take turns, the weight is shared by those who lead"
HULL = ABSENT + "a common value is a mean of the starting values"
