function buildTuft() {}
function restartTuft() {}
function stepTuft() {}
