function [names, values] = tabletop_step(folder)
% TABLETOP_STEP  Set sensor, run the callback script.  The reply holds motor, and exit if it is there.
request = tabletop_get([folder 'request.bin']);
tabletop_global('sensor', request.sensor);
tabletop_run('callbackFunc', folder);
[names, values] = tabletop_fields('motor', tabletop_global('motor'));
aux = tabletop_global('aux');
if ~isstruct(aux)
    error('tabletop:agent', 'aux is %dx%d %s; it must be a struct', size(aux, 1), size(aux, 2), class(aux));
end
if isfield(aux, 'exit')
    names{end + 1} = 'aux.exit';
    values{end + 1} = 1;
end
end
