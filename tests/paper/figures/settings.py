"""Every seed, duration and grid of the figures, in one place."""


def seeds(number):
    return range(1, number + 1)


# Figs. 2, 6 and 7, Table 1
PAIRS = 200  #: pairs of one run, each entering its contact at another phase of the step
STEPS_PER_CONTACT = (4, 8, 16, 32, 64)

# Fig. 8
GAS_SEEDS = seeds(40)  #: to tell a difference from chance
GAS_STEPS = (8, 16, 64)  #: steps in a contact, the last for what the others converge to

# Fig. 11
FREE_SEEDS = seeds(4)
FREE_DURATION = 11.0
FREE_AMPLITUDES = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0)  #: edges of the classes, mm

# Fig. 12
SAEKI_SEEDS = seeds(3)
SAEKI_FREQUENCIES = (10.0, 10.4, 10.8, 11.0, 11.1, 11.2, 11.3, 11.4, 11.5, 11.6, 11.77, 12.0, 12.4, 12.8, 13.4, 14.0)
SAEKI_DURATION, SAEKI_BARE_DURATION = 10.0, 60.0

# Fig. 14
LIST_SKINS = (0.05, 0.1, 0.2, 0.4)
LIST_DURATION = 0.06
STRUCK_SEEDS = seeds(10)

# Table 5 and Figs. 15 to 17
FREQUENCIES = (15.5, 15.7, 15.91, 16.1, 16.3, 16.5)
RESONANCE = 15.91
SEEDS = seeds(3)
RESONANCE_SEEDS = seeds(6)  #: at 15.91 Hz
DURATION = 7.0
WINDOW = (DURATION / 2.0, DURATION)

# 490 granules, work, Fig. 18 and Table 6, all at this frequency
SIZES_FREQUENCY = 15.5
SIZES = ((128, 2.5e-3), (188, 2.2e-3), (251, 2.0e-3), (317, 1.85e-3), (408, 1.7e-3), (490, 1.6e-3), (595, 1.5e-3),
         (732, 1.4e-3))  #: number and radius of 10 g
SIZES_SEEDS = seeds(4)
LAW_SEEDS = seeds(3)
MIXTURES = (((1.85e-3, 1.0),), ((1.6e-3, 0.5), (1.85e-3, 0.5)), ((1.6e-3, 0.5), (2.2e-3, 0.5)),
            ((1.4e-3, 0.5), (2.5e-3, 0.5)), ((1.6e-3, 0.25), (2.2e-3, 0.75)), ((1.6e-3, 0.75), (2.2e-3, 0.25)))
MIXTURE_SEEDS = seeds(4)
